"""Takes: read, checked field by field, opened, and written."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from _synthetic_take import BODY, SIZE, edit_json, named, true_postures, write_synthetic_take
from keymark.core.errors import InputError
from keymark.core.take.read_footage import check_frame_count, open_clip, rate_note
from keymark.core.take.take_file import read_take, write_take

FRAMES = 24


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_synthetic_take(tmp_path / "take", FRAMES)


def test_a_take_is_read_with_everything_in_it(folder: Path) -> None:
    take = read_take(folder)
    assert (take.fps, take.frame_start, take.frame_count) == (30.0, 1, FRAMES)
    assert take.camera.resolution == SIZE
    assert take.clip == folder / "frames"
    assert [style.segment for style in take.markers] == [
        "trunk",
        "forearm.L",
        "forearm.R",
        "shin.L",
        "shin.R",
    ]
    assert take.markers[1].color_srgb == (220, 50, 50)
    assert [keyframe.index for keyframe in take.keyframes] == [0, 8, 16, 23]
    assert take.notes == ()


def test_points_are_fitted_to_a_posture_that_reaches_them(folder: Path) -> None:
    take = read_take(folder)
    truth = BODY.points(BODY.pose(true_postures(FRAMES)))
    for keyframe in take.keyframes:
        reached = take.body.points(take.body.pose(keyframe.posture))
        assert np.abs(reached - truth[keyframe.index]).max() < 1e-3
        assert keyframe.residual_m < 1e-3


def test_frames_count_from_frame_start_and_any_order_is_sorted(folder: Path) -> None:
    def shift(value: dict[str, Any]) -> None:
        for row in value["keyframes"]:
            row["frame"] += 100
        value["keyframes"].reverse()

    edit_json(folder / "keyframes.json", shift)
    edit_json(folder / "take.json", frame_start=101)
    assert [keyframe.index for keyframe in read_take(folder).keyframes] == [0, 8, 16, 23]


def test_a_posture_by_name_is_taken_as_it_is(folder: Path) -> None:
    vector = true_postures(FRAMES).to_vector()[8]
    posture = dict(zip(BODY.skeleton.dof_names, vector.tolist(), strict=True))
    edit_json(
        folder / "keyframes.json", lambda v: v["keyframes"].__setitem__(1, {"frame": 9, "posture": posture})
    )
    assert np.allclose(read_take(folder).keyframes[1].posture.to_vector(), vector, atol=1e-12)


def test_points_that_no_posture_reaches_are_noted(folder: Path) -> None:
    def stretch(value: dict[str, Any]) -> None:
        points = value["keyframes"][1]["points"]
        value["keyframes"][1]["points"] = {name: (1.5 * np.array(p)).tolist() for name, p in points.items()}

    edit_json(folder / "keyframes.json", stretch)
    (note,) = read_take(folder).notes
    assert note.startswith("keyframe 9:") and "cm" in note


def test_a_written_take_is_read_back_the_same(folder: Path, tmp_path: Path) -> None:
    take = read_take(folder)
    write_take(take, tmp_path / "copy")
    back = read_take(tmp_path / "copy")
    assert back.markers == take.markers
    assert back.camera.to_dict() == take.camera.to_dict()
    assert dict(back.body.actor.segments_m) == dict(take.body.actor.segments_m)
    for ours, theirs in zip(back.keyframes, take.keyframes, strict=True):
        assert np.abs(ours.posture.minus(theirs.posture)).max() < 2e-6
    assert open_clip(back).frame_count == FRAMES


def test_writing_into_its_own_folder_leaves_the_clip_alone(folder: Path) -> None:
    before = sorted(path.name for path in folder.iterdir())
    write_take(read_take(folder), folder)
    assert sorted(path.name for path in folder.iterdir()) == before


def test_a_take_may_lack_keyframes_where_they_are_not_required(folder: Path) -> None:
    (folder / "keyframes.json").unlink()
    with pytest.raises(InputError, match=r"keyframes\.json"):
        read_take(folder)
    assert read_take(folder, keyframes_required=False).keyframes == ()
    with pytest.raises(InputError, match="mine"):
        read_take(folder, folder / "mine.json", keyframes_required=False)


def test_an_actor_may_be_given_by_height(folder: Path) -> None:
    edit_json(folder / "take.json", actor={"height_m": 1.75})
    assert read_take(folder).body.actor.segments_m["thigh.L"] == pytest.approx(0.238 * 1.75)


def test_markers_may_have_names_of_their_own(folder: Path) -> None:
    def rename(value: dict[str, Any]) -> None:
        value["markers"]["left sleeve"] = {**value["markers"].pop("forearm.L"), "segment": "forearm.L"}

    edit_json(folder / "take.json", rename)
    assert ("left sleeve", "forearm.L") in {
        (style.name, style.segment) for style in read_take(folder).markers
    }


MISTAKES: list[tuple[str, Callable[[dict[str, Any]], object], str]] = [
    ("fps missing", lambda v: v.pop("fps"), "fps is missing"),
    ("fps misspelt", lambda v: v.update(fpss=v.pop("fps")), "is 'fpss' meant"),
    ("fps text", lambda v: v.update(fps="30"), "fps is '30'"),
    ("fps zero", lambda v: v.update(fps=0), "fps is 0"),
    ("fps true", lambda v: v.update(fps=True), "fps is True"),
    ("frame_start", lambda v: v.update(frame_start=1.5), r"frame_start is 1\.5"),
    ("frame_count", lambda v: v.update(frame_count=1), "frame_count is 1"),
    ("clip outside", lambda v: v.update(clip="../other.mp4"), "inside the take's folder"),
    ("clip absolute", lambda v: v.update(clip="/etc/passwd"), "inside the take's folder"),
    ("clip on a drive", lambda v: v.update(clip="C:\\clip.mp4"), "inside the take's folder"),
    ("clip climbs", lambda v: v.update(clip="a\\..\\..\\clip.mp4"), "inside the take's folder"),
    ("clip number", lambda v: v.update(clip=7), "clip is 7"),
    ("clip with NUL", lambda v: v.update(clip="a\0b"), "clip is"),
    ("camera list", lambda v: v.update(camera=[]), r"camera is \[\]"),
    ("lens", lambda v: v["camera"].update(lens_mm=-1), "lens_mm is -1"),
    ("matrix", lambda v: v["camera"].update(matrix_world=[[1]]), "matrix_world"),
    ("markers mistyped", lambda v: v.update(marker=v.pop("markers")), "markers is missing .*'marker' meant"),
    (
        "unknown segment",
        lambda v: v["markers"].update({"girdle.L": {"color_srgb": [1, 2, 3]}}),
        "'girdle.L'.*known are trunk",
    ),
    ("segment number", lambda v: v["markers"]["trunk"].update(segment=3), "segment is 3"),
    ("color short", lambda v: v["markers"]["trunk"].update(color_srgb=[1, 2]), r"color_srgb is \[1, 2\]"),
    ("color range", lambda v: v["markers"]["trunk"].update(color_srgb=[1, 2, 256]), "color_srgb is"),
    ("same color", lambda v: v["markers"].update({"head": v["markers"]["trunk"]}), "same color_srgb"),
    ("actor missing", lambda v: v.pop("actor"), "actor is missing"),
    (
        "length missing",
        lambda v: v["actor"]["segments_m"].pop("trunk"),
        r"take\.json: actor.segments_m: trunk is missing",
    ),
    ("length", lambda v: v["actor"]["segments_m"].update(trunk=50), r"take\.json.*trunk is 50"),
    ("height", lambda v: v.update(actor={"height_m": 175}), "height_m is 175"),
    (
        "too few poses",
        lambda v: v["camera"].update(matrix_world_frames=[v["camera"]["matrix_world"]]),
        "has 1 poses",
    ),
]


@pytest.mark.parametrize(("change", "sentence"), [m[1:] for m in MISTAKES], ids=[m[0] for m in MISTAKES])
def test_a_mistake_in_take_json_is_named(
    folder: Path, change: Callable[[dict[str, Any]], object], sentence: str
) -> None:
    edit_json(folder / "take.json", change)
    with pytest.raises(InputError, match=sentence) as caught:
        read_take(folder)
    assert "take.json" in str(caught.value) and "\n" not in str(caught.value)


def keyframe_change(**fields: Any) -> Callable[[dict[str, Any]], object]:
    return lambda value: value["keyframes"][1].update(fields)


POSING_MISTAKES: list[tuple[str, Callable[[dict[str, Any]], object], str]] = [
    ("no list", lambda v: v.update(keyframes={}), r"keyframes is \{\}"),
    ("too few", lambda v: v.update(keyframes=v["keyframes"][:1]), "has 1 of them"),
    ("no object", lambda v: v["keyframes"].append(3), r"keyframes\[4\] is 3"),
    ("outside", keyframe_change(frame=25), "frame is 25.*1 to 24"),
    ("before", keyframe_change(frame=0), "frame is 0.*1 to 24"),
    ("half a frame", keyframe_change(frame=9.5), r"frame is 9\.5"),
    ("twice", keyframe_change(frame=1), "frame 1 is given twice"),
    ("neither", lambda v: v["keyframes"][1].pop("points"), "neither points nor posture"),
    ("point missing", lambda v: v["keyframes"][1]["points"].pop("head"), "head is missing"),
    ("point flat", lambda v: v["keyframes"][1]["points"].update(head=[0, 1]), r"head is \[0, 1\]"),
    ("point null", lambda v: v["keyframes"][1]["points"].update(head=[0, 1, None]), "head is"),
    ("point far", lambda v: v["keyframes"][1]["points"].update(head=[0, 1, 1e7]), "head is.*1000 m"),
    ("one place", keyframe_change(points=named(np.zeros((13, 3)))), "in one place"),
    ("depth", keyframe_change(depth="posed"), "depth is 'posed'; it must be one of found"),
    (
        "found twice",
        keyframe_change(
            depth="found",
            matched={"library": "walking", "posture": "Step", "mirrored": False, "confidence": 0.5},
        ),
        "both matched and depth",
    ),
    ("posture short", keyframe_change(posture={"waist.rotation_x": 0.1}), "pelvis.location_x is missing"),
    ("posture unknown", keyframe_change(posture={"tail.wag": 0.1}), "unknown degree of freedom 'tail.wag'"),
]


@pytest.mark.parametrize(
    ("change", "sentence"), [m[1:] for m in POSING_MISTAKES], ids=[m[0] for m in POSING_MISTAKES]
)
def test_a_mistake_in_keyframes_json_is_named(
    folder: Path, change: Callable[[dict[str, Any]], object], sentence: str
) -> None:
    edit_json(folder / "keyframes.json", change)
    with pytest.raises(InputError, match=sentence) as caught:
        read_take(folder)
    assert "keyframes.json" in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ('{"fps": 30, "cam', "line 1.*no valid JSON"),
        ('{"fps": NaN}', "NaN is no number"),
        ('{"fps": -Infinity}', "-Infinity is no number"),
        ('{"fps": 1e999}', "too large"),
        ('{"fps": 1' + "0" * 5000 + "}", "too large"),
        ('{"fps": 30, "fps": 25}', "'fps' stands twice"),
        ("[1, 2]", r"holds \[1, 2\]"),
        ("", "no valid JSON"),
        ("[" * 100_000, "nested too deeply"),
    ],
    ids=["cut off", "NaN", "infinite", "too large", "digits", "twice", "list", "empty", "deep"],
)
def test_a_damaged_file_is_named(folder: Path, text: str, sentence: str) -> None:
    (folder / "take.json").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=sentence) as caught:
        read_take(folder)
    assert "take.json" in str(caught.value)


def test_a_clip_that_does_not_fit_is_named(folder: Path) -> None:
    fits = read_take(folder)
    assert open_clip(fits).size == SIZE
    edit_json(folder / "take.json", lambda value: value["camera"].update(resolution=[320, 240]))
    with pytest.raises(InputError, match=r"camera.resolution is \[320, 240\].*\[160, 120\]"):
        open_clip(read_take(folder))
    with pytest.raises(InputError, match="frame_count is 24.*holds 20 frames"):
        check_frame_count(fits, 20)
    shutil.rmtree(folder / "frames")
    with pytest.raises(InputError, match="frames: no such file"):
        open_clip(fits)


def test_the_clip_decides_where_take_json_does_not_count(folder: Path) -> None:
    edit_json(folder / "take.json", lambda value: value.pop("frame_count"))
    edit_json(folder / "keyframes.json", keyframe_change(frame=60))
    take = read_take(folder)
    with pytest.raises(InputError, match="keyframe 60 lies outside the clip, whose frames are 1 to 24"):
        open_clip(take)


def test_a_rate_unlike_the_clips_is_noted(folder: Path) -> None:
    writer = cv2.VideoWriter(str(folder / "clip.avi"), cv2.VideoWriter.fourcc(*"MJPG"), 15.0, SIZE)
    for _ in range(FRAMES):
        writer.write(np.full((SIZE[1], SIZE[0], 3), 90, dtype=np.uint8))
    writer.release()
    edit_json(folder / "take.json", clip="clip.avi")
    take = read_take(folder)
    note = rate_note(take, open_clip(take))
    assert note is not None and "30" in note and "15" in note
    edit_json(folder / "take.json", fps=15)
    take = read_take(folder)
    assert rate_note(take, open_clip(take)) is None


def test_the_shared_takes_are_read(take_folder: Callable[[str], Path]) -> None:
    for name in ("walk", "reach", "aerobic", "real_balance"):
        take = read_take(take_folder(name), take_folder(name) / "keyframes_noisy.json")
        assert open_clip(take).frame_count == take.frame_count
        assert take.notes == ()
