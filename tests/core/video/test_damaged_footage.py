"""Footage as people send it: every frame in its place, and a sentence on what is wrong."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from _footage import (
    FPS,
    FRAMES,
    H264,
    cut_off,
    encode,
    ffmpeg,
    images_of,
    number_of,
    overwritten,
    take_with,
    write_numbered_take,
)
from _fuzz import FUZZ
from _synthetic_take import SIZE
from hypothesis import given, settings
from hypothesis import strategies as st
from keymark.core.errors import InputError
from keymark.core.progress import run
from keymark.core.take import read_footage as footage_reading
from keymark.core.take.read_footage import open_clip, open_footage, read_footage
from keymark.core.take.take_file import read_take
from keymark.core.video.clip import Clip
from keymark.core.video.frame_checks import FrameChecks

LOST = 0
"""What is read from a black frame."""
BT2020 = (*H264, "-color_primaries", "bt2020", "-colorspace", "bt2020nc")
SHORT_GROUPS = (*H264, "-g", "8", "-bf", "2", "-movflags", "+faststart")


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_numbered_take(tmp_path_factory.mktemp("drawn"))


@pytest.fixture
def video(drawn: Path, tmp_path: Path) -> Callable[..., Path]:
    """A function from a name and ffmpeg's arguments to the take as such a video."""
    return lambda name, *arguments: encode(drawn, tmp_path / name, *arguments)


def numbers(clip: Clip) -> list[int]:
    return [number_of(image) for _, _, image in clip.frames()]


def noticed(clip: Clip) -> tuple[str, ...]:
    checks = FrameChecks()
    for index, _, image in clip.frames():
        checks.add(index, image)
    return checks.findings().notes(1)


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("a.mp4", H264),
        ("a.mkv", H264),
        ("a.ts", H264),
        ("a.h264", H264),
        ("b_frames.mp4", (*H264, "-bf", "3")),
        ("late.mp4", (*H264, "-output_ts_offset", "2")),
        ("hevc.mp4", ("-c:v", "libx265", "-preset", "ultrafast", "-x265-params", "log-level=none:pools=1")),
        ("a.webm", ("-c:v", "libvpx", "-b:v", "1M")),
        ("alpha.mov", ("-c:v", "prores_ks", "-profile:v", "4", "-pix_fmt", "yuva444p10le")),
        ("deep.mkv", ("-c:v", "ffv1", "-pix_fmt", "rgb48le")),
        ("raw.avi", ("-c:v", "rawvideo", "-pix_fmt", "bgr24")),
        ("jpeg.avi", ("-c:v", "mjpeg", "-q:v", "2")),
        ("a.mpg", ("-c:v", "mpeg2video", "-q:v", "2")),
        ("odd.mp4", ("-vf", "scale=161:121", "-c:v", "libx264", "-pix_fmt", "yuv444p")),
    ],
)
def test_ordinary_kinds_give_every_frame_once(
    video: Callable[..., Path], name: str, arguments: tuple[str, ...]
) -> None:
    clip = Clip.open(video(name, *arguments))
    assert numbers(clip) == list(range(FRAMES))
    assert clip.frame_count == FRAMES and clip.notes == () and noticed(clip) == ()
    fps = clip.fps if name.endswith(".h264") else FPS  # without a container decoders guess the rate
    np.testing.assert_allclose(list(clip.source.time_stamps()), np.arange(FRAMES) / fps, atol=1.1e-3)
    assert [(index, number_of(image)) for index, image in clip.sample(3)] == [(4, 4), (12, 12), (20, 20)]


@pytest.mark.parametrize("depth", ["10", "12"])
@pytest.mark.parametrize("turned", [0, 90, 180, 270])
def test_video_of_phones_is_the_same_in_every_run(
    video: Callable[..., Path], tmp_path: Path, depth: str, turned: int
) -> None:
    flat = video(
        "flat.mp4", "-frames:v", "2", "-vf", "scale=160:106", "-c:v", "libx265", "-preset", "ultrafast",
        "-x265-params", "log-level=none:pools=1", "-pix_fmt", f"yuv420p{depth}le",
    )  # fmt: skip
    path = tmp_path / "turned.mp4"
    ffmpeg("-display_rotation", str(turned), "-i", flat, "-c", "copy", path)
    clip = Clip.open(path)
    assert clip.size == ((106, 160) if turned % 180 else (160, 106))
    image = next(clip.frames())[2]
    upright = np.rot90(image, -turned // 90)  # ffmpeg turns against the clock
    np.testing.assert_array_equal(upright[-3:], np.broadcast_to(upright[-4], upright[-3:].shape))


def test_frames_lost_in_the_middle_leave_the_others_in_their_places(video: Callable[..., Path]) -> None:
    clip = Clip.open(overwritten(video("a.mp4", *SHORT_GROUPS), 0.52, 2500))
    read = numbers(clip)
    assert len(read) == FRAMES
    lost = [index for index, number in enumerate(read) if number != index]
    assert 0 < len(lost) < 12 and read[-1] == FRAMES - 1
    np.testing.assert_allclose(np.diff(list(clip.source.time_stamps())), 1.0 / FPS, atol=1e-6)
    (note,) = noticed(clip)
    assert " of 24 frames " in note and " blank (" in note and "damaged" in note
    sampled = dict(clip.source.at([2, FRAMES - 1]))
    assert {index: number_of(image) for index, image in sampled.items()} == {2: 2, FRAMES - 1: FRAMES - 1}


def test_what_is_cut_off_ends_early_or_is_refused(video: Callable[..., Path]) -> None:
    clip = Clip.open(cut_off(video("front.mp4", *SHORT_GROUPS), 0.6))
    read = numbers(clip)
    assert all(number in (index, LOST) for index, number in enumerate(read))
    assert read.count(LOST) <= 2 and 4 < len(read) < FRAMES == clip.frame_count
    with pytest.raises(InputError, match=r"end\.mp4: .*whole"):
        Clip.open(cut_off(video("end.mp4", *H264), 0.6))


def test_streams_beside_the_picture_do_not_disturb(drawn: Path, tmp_path: Path) -> None:
    sound = ("-f", "lavfi", "-i", "sine=440:d=2")
    path = tmp_path / "sound.mp4"
    ffmpeg(*sound, *images_of(drawn), "-map", "0:a", "-map", "1:v", *H264, "-c:a", "aac", path)
    assert numbers(Clip.open(path)) == list(range(FRAMES))
    alone = tmp_path / "alone.mp4"
    ffmpeg(*sound, "-c:a", "aac", alone)
    with pytest.raises(InputError, match=r"alone\.mp4: cannot be decoded"):
        Clip.open(alone)


def test_a_coding_that_is_not_known_is_named(drawn: Path, tmp_path: Path) -> None:
    path = tmp_path / "a.mp4"
    ffmpeg(*images_of(drawn), "-frames:v", "2", "-c:v", "libaom-av1", "-cpu-used", "8", path)
    try:
        clip = Clip.open(path)
    except InputError as error:
        assert "AV01" in str(error) and "libx264" in str(error)
    else:  # an OpenCV that can
        assert numbers(clip) == [0, 1]


def test_claims_of_frames_are_not_believed_blindly(tmp_path: Path) -> None:
    cover, path = tmp_path / "cover.png", tmp_path / "music.m4a"
    cv2.imwrite(str(cover), np.full((60, 60, 3), (0, 0, 255), dtype=np.uint8))
    ffmpeg(
        "-f", "lavfi", "-i", "sine=440:d=2", "-i", cover, "-map", "0", "-map", "1", "-c:a", "aac",
        "-c:v", "png", "-disposition:v:0", "attached_pic", path,
    )  # fmt: skip
    clip = Clip.open(path)
    assert len(list(clip.frames())) == 1
    assert clip.frame_count <= path.stat().st_size // 8


def test_a_size_that_changes_is_refused(drawn: Path, tmp_path: Path) -> None:
    for name, size in (("a.ts", "160:120"), ("b.ts", "80:60")):
        ffmpeg(*images_of(drawn), "-frames:v", "8", "-vf", f"scale={size}", *H264, tmp_path / name)
    both = tmp_path / "both.ts"
    both.write_bytes((tmp_path / "a.ts").read_bytes() + (tmp_path / "b.ts").read_bytes())
    try:
        shapes = {image.shape for _, _, image in Clip.open(both).frames()}
    except InputError as error:
        assert "80 x 60" in str(error) and "160 x 120" in str(error)
    else:  # the decoder scaled them
        assert shapes == {(120, 160, 3)}


@pytest.mark.parametrize(
    ("name", "arguments", "word"),
    [
        ("pq.mp4", (*BT2020, "-color_trc", "smpte2084"), "(PQ)"),
        ("hlg.mkv", (*BT2020, "-color_trc", "arib-std-b67"), "(HLG)"),
    ],
)
def test_what_the_file_says_of_itself_is_told(
    video: Callable[..., Path], name: str, arguments: tuple[str, ...], word: str
) -> None:
    (note,) = Clip.open(video(name, *arguments)).notes
    assert word in note and name in note and "convert" in note


@pytest.mark.parametrize(
    ("stored", "shape", "words"),
    [((120, 120), "4/3", "1.33 times"), ((160, 90), "3/4", "0.75 times")],
    ids=["wide", "high"],
)
def test_oblong_pixels_are_scaled_to_square_ones(
    drawn: Path, video: Callable[..., Path], stored: tuple[int, int], shape: str, words: str
) -> None:
    path = video("a.mp4", "-vf", f"scale={stored[0]}:{stored[1]},setsar={shape}", *H264)
    clip = Clip.open(path)
    assert (clip.size, clip.stored_size) == (SIZE, stored) and numbers(clip) == list(range(FRAMES))
    first = cv2.imread(str(next(iter(sorted((drawn / "frames").iterdir())))))
    assert np.abs(next(clip.frames())[2].astype(float) - first).mean() < 4.0  # levels
    assert f"{words} as wide as high: its pictures of {stored[0]} x {stored[1]} were scaled" in clip.notes[0]
    left = Clip.open(path, size=stored)
    assert left.size == next(left.frames())[2].shape[1::-1] == stored and "convert" in left.notes[0]


def test_oblong_pixels_turn_with_the_picture(video: Callable[..., Path], tmp_path: Path) -> None:
    flat = video("flat.mp4", "-vf", "scale=120:120,setsar=4/3", *H264)
    ffmpeg("-display_rotation", "90", "-i", flat, "-c", "copy", tmp_path / "turned.mp4")
    clip = Clip.open(tmp_path / "turned.mp4")
    assert clip.size == SIZE[::-1] == next(clip.frames())[2].shape[1::-1]


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("-vf", "drawbox=c=black:t=fill:enable='gte(n,12)'"), "12 of 24 frames are blank (frames 13 to 24)"),
        (("-vf", "tinterlace=interleave_top,fieldorder=tff", "-flags", "+ilme+ildct"), "interlaced"),
        (("-vf", "negate=enable='gte(n,10)'"), "cut at frame 11"),
    ],
    ids=["black half", "interlaced", "cut"],
)
def test_what_the_frames_show_is_told(
    video: Callable[..., Path], arguments: tuple[str, ...], expected: str
) -> None:
    (note,) = noticed(Clip.open(video("a.mp4", *arguments, *H264)))
    assert expected in note


def test_no_take_of_ours_is_suspected(take_folder: Callable[[str], Path], repository: Path) -> None:
    folders = [take_folder(name) for name in ("walk", "reach", "real_balance")]
    for folder in [*folders, repository / "presets" / "demo" / "aerobic"]:
        checks = FrameChecks()
        clip = Clip.open(folder / "clip.mp4")
        for place, (_, image) in enumerate(clip.source.at(range(0, clip.frame_count, 6))):
            checks.add(15 * place, image)
        assert checks.findings().notes(1) == () and checks.nothing_seen() is None


@pytest.mark.parametrize(
    ("picture", "why"),
    [
        (np.zeros((48, 64, 3), dtype=np.uint8), "black"),
        (np.full((48, 64, 3), 250, dtype=np.uint8), "one color"),
        (np.tile(np.arange(64, dtype=np.uint8)[None, :, None] * 3, (48, 1, 3)), "no colors"),
    ],
    ids=["black", "white", "gray"],
)
def test_why_nothing_can_be_found_is_known(picture: np.ndarray, why: str) -> None:
    checks = FrameChecks()
    for index in range(3):
        checks.add(index, picture)
    assert why in (checks.nothing_seen() or "")


def test_a_clip_of_hours_is_refused_before_it_is_read(drawn: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    described = read_take(drawn)
    whole = replace(described, frame_count=None)
    monkeypatch.setattr(footage_reading, "LONGEST_FRAMES", FRAMES)
    assert open_clip(whole).frame_count == FRAMES
    monkeypatch.setattr(footage_reading, "LONGEST_FRAMES", FRAMES - 1)
    sentence = rf"more than {FRAMES - 1} frames.*must be shorter: cut it, as with ffmpeg .*-t \d+ "
    for read in (lambda: open_clip(whole), lambda: open_footage(whole.clip, None)):
        with pytest.raises(InputError, match=sentence):
            read()


def test_a_turned_clip_and_one_cut_off_say_what_to_do(video: Callable[..., Path], drawn: Path) -> None:
    turned = video("turned.mp4", "-vf", "transpose=1", *H264)
    with pytest.raises(InputError, match=r"120, 160.*swap"):
        open_clip(read_take(take_with(turned, drawn)))
    turned.unlink()
    short = cut_off(video("short.mp4", *SHORT_GROUPS), 0.6)
    with pytest.raises(InputError, match=rf"keyframe \d+ lies outside.*claims {FRAMES}"):
        run(read_footage(read_take(take_with(short, drawn))))


def write_images(folder: Path, names: list[str]) -> Path:
    folder.mkdir()
    for level, name in enumerate(names):
        cv2.imwrite(str(folder / name), np.full((12, 16, 3), 40 + level, dtype=np.uint8))
    return folder


def levels(clip: Clip) -> list[int]:
    return [int(image[0, 0, 0]) for _, _, image in clip.frames()]


def test_an_image_that_is_missing_keeps_its_place(tmp_path: Path) -> None:
    clip = Clip.open(write_images(tmp_path / "a", ["a1.png", "a2.png", "a5.png", "a6.png"]))
    assert levels(clip) == [40, 41, LOST, LOST, 42, 43]
    assert "2 of 6 images are missing" in clip.notes[0] and "number 3, 4" in clip.notes[0]
    even = Clip.open(write_images(tmp_path / "b", ["a1.png", "a3.png", "a5.png"]))
    assert levels(even) == [40, 41, 42] and even.notes == ()
    sparse = Clip.open(write_images(tmp_path / "c", ["a1.png", "a2.png", "a40.png"]))
    assert levels(sparse) == [40, 41, 42] and "gaps" in sparse.notes[0]


def test_what_does_not_belong_to_a_sequence_is_left_out(tmp_path: Path) -> None:
    folder = write_images(tmp_path / "a", ["a1.png", "a2.PNG".lower(), "cover.jpg"])
    (folder / "._a1.png").write_bytes(b"\x00\x05\x16\x07")
    clip = Clip.open(folder)
    assert levels(clip) == [40, 41]
    assert "cover.jpg" in clip.notes[0] and len(clip.notes) == 1
    with pytest.raises(InputError, match=r"2 sequences .*left1\.png .*right1\.png"):
        Clip.open(write_images(tmp_path / "b", ["left1.png", "left2.png", "right1.png", "right2.png"]))


@pytest.mark.parametrize("share", [0.3, 0.9])
def test_a_damaged_image_is_named_and_nothing_else_is_said(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], share: float
) -> None:
    folder = write_images(tmp_path / "a", ["a1.png", "a2.png"])
    noise = np.random.default_rng(0).integers(0, 256, (40, 60, 3), dtype=np.uint8)
    for name in ("a1.png", "a2.png"):
        cv2.imwrite(str(folder / name), noise)
    (overwritten if share < 0.5 else cut_off)(folder / "a2.png", share, *((30,) if share < 0.5 else ()))
    with pytest.raises(InputError, match=r"a2\.png: cannot be decoded"):
        list(Clip.open(folder).frames())
    assert capfd.readouterr().err == ""


@pytest.fixture(scope="module")
def wholes(drawn: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    folder = tmp_path_factory.mktemp("wholes")
    kinds = {"a.mp4": SHORT_GROUPS, "a.mkv": H264, "a.ts": H264, "a.avi": ("-c:v", "mjpeg", "-q:v", "4")}
    return {name: encode(drawn, folder / name, *how).read_bytes() for name, how in kinds.items()}


@pytest.mark.fuzz
@settings(max_examples=25 * FUZZ)
@given(
    name=st.sampled_from(["a.mp4", "a.mkv", "a.ts", "a.avi"]),
    start=st.floats(0.0, 1.0),
    length=st.sampled_from([1, 4, 40, 400, 4000]),
    share=st.sampled_from([1.0, 1.0, 0.9, 0.5, 0.02]),
    seed=st.integers(0, 9),
)
def test_damage_anywhere_is_survived(
    wholes: dict[str, bytes],
    tmp_path_factory: pytest.TempPathFactory,
    name: str,
    start: float,
    length: int,
    share: float,
    seed: int,
) -> None:
    path = tmp_path_factory.getbasetemp() / f"damaged_{name}"
    path.write_bytes(wholes[name])
    cut_off(overwritten(path, start, length, seed), share)
    try:
        clip = Clip.open(path)
        stamps = []
        for _, time_s, image in clip.frames():
            stamps.append(time_s)
            assert image.dtype == np.uint8 and image.shape == (clip.size[1], clip.size[0], 3)
            assert len(stamps) <= 4 * FRAMES
    except InputError as error:
        assert str(path) in str(error) and "\n" not in str(error)
    else:
        assert np.isfinite(stamps).all() and (np.diff(stamps) > 0.0).all()
