"""What is read of a clip: known again, kept as arrays, and read anew where anything differs."""

import os
import shutil
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from _boot import ROOT
from _drawn_clip import write_video
from _synthetic_take import write_synthetic_take
from keymark.core.files.digest import digest, file_fingerprint
from keymark.core.markers.reading import (
    Reading,
    clip_times,
    read_clip,
    reading_arrays,
    reading_from_arrays,
    reading_key,
)
from keymark.core.markers.region_tracks import MarkerStyle, RegionTracks
from keymark.core.progress import run
from keymark.core.take.read_footage import read_footage
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take
from keymark.core.video import clip as clip_module
from keymark.core.video.clip import Clip
from keymark.core.video.video_file import VideoFile

FRAMES = 24


@pytest.fixture
def take(tmp_path: Path) -> Take:
    return read_take(write_synthetic_take(tmp_path / "take", frames=FRAMES, keyframe_every=8))


@pytest.fixture
def passes(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    counted: list[int] = []
    original = clip_module.ImageSequence.frames

    def frames(self: clip_module.ImageSequence):  # noqa: ANN202
        counted.append(1)
        return original(self)

    monkeypatch.setattr(clip_module.ImageSequence, "frames", frames)
    return counted


def assert_alike(one: RegionTracks, other: RegionTracks) -> None:
    for field in fields(RegionTracks):
        a, b = getattr(one, field.name), getattr(other, field.name)
        assert np.array_equal(a, b, equal_nan=True) if isinstance(a, np.ndarray) else a == b


def moved(take: Take, by: float) -> Take:
    """The take with its second keyframe displaced [m] across the picture."""
    step = np.zeros(take.body.skeleton.dof_count)
    step[0] = by
    changed = replace(take.keyframes[1], posture=take.keyframes[1].posture.plus(step))
    return replace(take, keyframes=(take.keyframes[0], changed, *take.keyframes[2:]))


def test_a_reading_survives_as_arrays(take: Take) -> None:
    reading = replace(run(read_footage(take)), notes=("it may be cut off",))
    back = reading_from_arrays(reading_arrays(reading))
    assert_alike(back.tracks, reading.tracks)
    assert back.notes == reading.notes and back.key == reading.key
    assert back.album is not None and reading.album is not None
    for frame in (0, FRAMES - 1):
        assert np.array_equal(back.album.picture(frame), reading.album.picture(frame))
    assert FRAMES not in back.album
    assert back.detections is not None and reading.detections is not None
    assert back.detections.learning_rounds == reading.detections.learning_rounds
    bare = reading_from_arrays(reading_arrays(Reading(reading.tracks)))
    assert bare.album is None and bare.detections is None and bare.notes == () and bare.key == ""


def test_an_unchanged_take_is_not_read_again(take: Take, passes: list[int]) -> None:
    reading = run(read_footage(take))
    again = run(read_footage(take, reading))
    assert again.detections is reading.detections and again.tracks is reading.tracks
    assert len(passes) == 1


def test_a_moved_keyframe_needs_no_pass_where_colors_stay(take: Take, passes: list[int]) -> None:
    kept = reading_from_arrays(reading_arrays(run(read_footage(take))))
    changed = moved(take, 0.03)
    again = run(read_footage(changed, kept))
    assert len(passes) == 1
    fresh = run(read_footage(changed))
    assert_alike(again.tracks, fresh.tracks)
    assert again.key == fresh.key != kept.key
    without = replace(take, keyframes=())
    assert_alike(run(read_footage(without, kept)).tracks, run(read_footage(without)).tracks)


def test_a_keyframe_that_hides_a_color_has_the_clip_read_anew(take: Take, passes: list[int]) -> None:
    kept = run(read_footage(take))
    far = moved(take, 0.9)
    again = run(read_footage(far, kept))
    assert len(passes) == 2
    assert_alike(again.tracks, run(read_footage(far)).tracks)


@pytest.mark.parametrize("change", ["clip", "touched", "color", "segment"])
def test_whatever_else_changes_has_the_clip_read_anew(take: Take, passes: list[int], change: str) -> None:
    kept = run(read_footage(take))
    image = sorted((take.folder / "frames").iterdir())[3]
    style = take.markers[0]
    if change == "clip":
        image.write_bytes(sorted((take.folder / "frames").iterdir())[9].read_bytes())
    elif change == "touched":
        os.utime(image, (1000, 1000))
    elif change == "color":
        take = replace(take, markers=(replace(style, color_srgb=(44, 150, 70)), *take.markers[1:]))
    else:
        take = replace(take, markers=(replace(style, segment="chest"), *take.markers[1:]))
    again = run(read_footage(take, kept))
    assert len(passes) == 2 and again.detections is not kept.detections


def test_pictures_are_kept_for_a_camera_that_stands_still_only(take: Take, passes: list[int]) -> None:
    poses = np.repeat(take.camera.matrix_world[None], FRAMES, axis=0)
    poses[1:, 0, 3] += 0.01
    moving = replace(take, camera=replace(take.camera, matrix_world=poses))
    assert run(read_footage(moving, run(read_footage(take)))).album is None
    without = run(read_footage(moving))
    assert run(read_footage(take, without)).album is not None
    assert len(passes) == 3


def test_digests_tell_like_from_unlike(tmp_path: Path) -> None:
    alike: Callable[..., bool] = lambda a, b: digest(*a) == digest(*b)  # noqa: E731
    assert alike((1, "a", np.arange(3)), (1, "a", np.arange(3)))
    for one, other in (
        (("ab", "c"), ("a", "bc")),
        ((1,), (1.0,)),
        ((None,), ("None",)),
        ((("a",), "b"), (("a", "b"),)),
        ((np.zeros(4),), (np.zeros((2, 2)),)),
        ((np.zeros(2),), (np.zeros(2, np.float32),)),
        ((b"1",), ("1",)),
    ):
        assert not alike(one, other)
    with pytest.raises(TypeError, match="dict"):
        digest({})
    file = tmp_path / "file"
    file.write_bytes(bytes(300_000))
    before = file_fingerprint(file)
    state = file.stat()
    file.write_bytes(bytes(150_000) + b"1" + bytes(149_999))
    os.utime(file, ns=(state.st_atime_ns, state.st_mtime_ns))
    assert file_fingerprint(file) != before


DEMO = ROOT / "presets" / "demo" / "aerobic"


@pytest.fixture
def decoded(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The clips that are decoded for their times, one entry a pass."""
    seen: list[Path] = []
    decode = VideoFile.time_stamps

    def counted(video: VideoFile):  # noqa: ANN202
        seen.append(video.path)
        return decode(video)

    monkeypatch.setattr(VideoFile, "time_stamps", counted)
    return seen


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    return Path(shutil.copy(DEMO / "clip.mp4", tmp_path))


def test_a_clip_is_decoded_once_for_its_times(clip: Path, decoded: list[Path]) -> None:
    first, second = (run(clip_times(Clip.open(clip))) for _ in range(2))
    assert decoded == [clip]
    np.testing.assert_array_equal(first, list(Clip.open(clip).source.time_stamps()))
    np.testing.assert_array_equal(second, first)
    assert len(first) > 1


def test_a_clip_that_has_changed_is_decoded_again(clip: Path, decoded: list[Path]) -> None:
    first = run(clip_times(Clip.open(clip)))
    write_video(clip, range(0, 100, 10), 30.0)
    assert len(run(clip_times(Clip.open(clip)))) == 10 != len(first)
    assert decoded == [clip, clip]


def test_a_reading_of_the_clip_knows_its_times(clip: Path, decoded: list[Path]) -> None:
    opened = Clip.open(clip)
    reading = run(read_clip(opened, (), with_album=False))
    style = MarkerStyle("trunk", "trunk", (70, 106, 213))
    found = run(clip_times(opened, reading))
    assert decoded == []
    np.testing.assert_array_equal(found, list(opened.source.time_stamps()))
    os.utime(clip, (1, 1))
    run(clip_times(opened, reading))
    os.utime(clip, (2, 2))
    run(clip_times(opened, replace(reading, key=reading_key(clip, opened.fps, (style,), None))))
    assert decoded == [clip] * 3  # one of them just now, to compare


def test_a_pass_that_was_broken_off_leaves_nothing(clip: Path, decoded: list[Path]) -> None:
    broken = clip_times(Clip.open(clip))
    next(broken)
    broken.close()
    assert len(run(clip_times(Clip.open(clip)))) > 1
    assert len(decoded) == 2


def test_only_the_last_clips_are_remembered(clip: Path, tmp_path: Path, decoded: list[Path]) -> None:
    others = [tmp_path / f"{number}.mp4" for number in range(8)]
    for number, other in enumerate(others):
        other.write_bytes(clip.read_bytes())
        os.utime(other, (100 + number, 100 + number))  # the fingerprint has the time
    for path in (clip, *others, clip):
        run(clip_times(Clip.open(path)))
    assert decoded == [clip, *others, clip]
