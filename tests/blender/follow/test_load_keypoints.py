"""Keypoints of a take: detected, loaded, switched, moved, changed, saved, and followed with nothing else."""

import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from _drawn_clip import MiddleNetwork
from keymark.core.detect.keypoint_file import write_keypoints
from keymark.core.take.description import describe
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take
from keymark.operators.follow.evidence import (
    clear_readings,
    contours_label,
    keypoint_path,
    keypoint_reading,
    keypoints_at,
    keypoints_label,
)
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take

FRAMES = 13


def load(path: Path) -> bpy.types.PropertyGroup:
    assert bpy.ops.keymark.load_keypoints(filepath=str(path)) == {"FINISHED"}
    clear_readings()
    return active_take(bpy.context.scene)


def reading(take: bpy.types.PropertyGroup):
    clear_readings()
    return keypoint_reading(take, take.follow.files[take.follow.active_file])


def openpose_folder(folder: Path, motion: Motion, take: Take) -> Path:
    """What OpenPose writes for COCO's 18 points: one file a frame, the elbows and wrists only."""
    folder.mkdir()
    pixel, _ = take.camera.project(motion.points)
    names = take.body.skeleton.point_names
    coco = {2: "shoulder.R", 3: "elbow.R", 4: "wrist.R", 5: "shoulder.L", 6: "elbow.L", 7: "wrist.L"}
    for frame in range(FRAMES):
        points = np.zeros((25, 3))
        for row, name in coco.items():
            points[row] = *pixel[frame, names.index(name)], 0.8
        value = {"version": 1.3, "people": [{"pose_keypoints_2d": points.ravel().tolist()}]}
        (folder / f"clip_{frame:012d}_keypoints.json").write_text(json.dumps(value), encoding="utf-8")
    return folder


def test_a_plain_take_is_reconstructed_from_keypoints(
    plain: bpy.types.Scene, keypoint_file: Path, wave_motion: Motion, shown_points: Callable
) -> None:
    take = load(keypoint_file)
    take.follow.use_contours = False
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
    errors = []
    for frame in range(1, FRAMES + 1):
        plain.frame_set(frame)
        away = shown_points(active_take(plain).armature) - wave_motion.points[frame - 1]
        errors.append(np.linalg.norm(away, axis=1))
    assert np.mean(errors) < 0.02


def test_what_is_seen_is_said(plain: bpy.types.Scene, keypoint_file: Path) -> None:
    assert keypoints_label(active_take(plain)) == ""
    take = load(keypoint_file)
    (seen,) = keypoints_at(take, 5)
    assert (seen.source, seen.seen_count, seen.pixel.shape) == ("truth", 13, (1, 13, 2))
    assert keypoints_label(take) == "13 of 13"
    assert keypoints_at(take, 400)[0].seen_count == 0
    take.follow.files[0].is_used = False
    assert keypoints_at(take, 5) == () and keypoints_label(take) == ""
    take.follow.files[0].is_used, take.follow.use_keypoints = True, False
    assert keypoints_at(take, 5) == () and keypoints_label(take) == "Off"


def test_a_file_is_listed_once_and_removed_again(
    plain: bpy.types.Scene, keypoint_file: Path, plain_take: Take, wave_motion: Motion, tmp_path: Path
) -> None:
    load(keypoint_file)
    folder = openpose_folder(tmp_path / "openpose", wave_motion, plain_take)
    take = load(next(folder.iterdir()))
    assert [Path(entry.filepath).name for entry in take.follow.files] == ["seen.json", "openpose"]
    assert len(reading(take).people.frames) == FRAMES
    load(keypoint_file)
    assert (len(take.follow.files), take.follow.active_file) == (2, 0)
    take.follow.active_file = 1
    assert bpy.ops.keymark.remove_keypoints() == {"FINISHED"}
    assert [Path(entry.filepath).name for entry in take.follow.files] == ["seen.json"]
    assert bpy.ops.keymark.remove_keypoints() == {"FINISHED"} and keypoint_file.is_file()
    with pytest.raises(RuntimeError, match="Load keypoints first"):
        bpy.ops.keymark.remove_keypoints()


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda value: value.update(frames=value["frames"][:5]), r"seen\.json.*5 .*13"),
        (lambda value: value.update(frames=[None] * FRAMES), r"seen\.json: nobody is seen"),
        (lambda value: value.clear(), r"seen\.json"),
    ],
)
def test_a_file_that_is_none_of_the_clips_is_refused(
    plain: bpy.types.Scene, keypoint_file: Path, change: Callable, sentence: str
) -> None:
    value = json.loads(keypoint_file.read_text(encoding="utf-8"))
    change(value)
    keypoint_file.write_text(json.dumps(value), encoding="utf-8")
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.keymark.load_keypoints(filepath=str(keypoint_file))
    assert len(active_take(plain).follow.files) == 0


def test_a_file_that_is_gone_is_said_and_found_again(
    plain: bpy.types.Scene, keypoint_file: Path, tmp_path: Path
) -> None:
    take = load(keypoint_file)
    moved = Path(shutil.move(keypoint_file, tmp_path / "moved.json"))
    assert reading(take).is_missing and keypoints_at(take, 5) == ()
    with pytest.raises(RuntimeError, match=r"seen\.json: the keypoints are not there"):
        bpy.ops.keymark.reconstruct()
    assert bpy.ops.keymark.load_keypoints(filepath=str(moved), replace=True) == {"FINISHED"}
    assert len(take.follow.files) == 1 and reading(take).people is not None


def test_a_file_that_was_written_again_is_said_and_used(
    plain: bpy.types.Scene, keypoint_file: Path, plain_take: Take, wave_motion: Motion, seen_by: Callable
) -> None:
    take = load(keypoint_file)
    assert not reading(take).has_changed
    write_keypoints(keypoint_file, seen_by(plain_take, wave_motion, others=1), 1, plain_take.fps)
    os.utime(keypoint_file, (1.0, 1.0))
    assert reading(take).has_changed
    assert keypoints_at(take, 5)[0].pixel.shape == (2, 13, 2)
    load(keypoint_file)
    assert not reading(take).has_changed


def test_the_blend_file_remembers_where_keypoints_are(
    plain: bpy.types.Scene, keypoint_file: Path, tmp_path: Path
) -> None:
    project = keypoint_file.parent
    bpy.ops.wm.save_as_mainfile(filepath=str(project / "work.blend"))
    take = load(keypoint_file)
    assert take.follow.files[0].filepath == "//seen.json"
    bpy.ops.wm.save_as_mainfile(filepath=str(project / "work.blend"))
    other = tmp_path / "elsewhere"
    other.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(other / "alone.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(other / "alone.blend"))
    assert keypoints_at(active_take(bpy.context.scene), 5)[0].seen_count == 13
    shutil.move(project, tmp_path / "renamed")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "renamed" / "work.blend"))
    assert keypoints_at(active_take(bpy.context.scene), 5)[0].seen_count == 13


def test_another_clip_drops_what_was_seen_in_the_first(
    plain: bpy.types.Scene, keypoint_file: Path, tmp_path: Path
) -> None:
    take = load(keypoint_file)
    take.follow.use_contours = False
    bpy.ops.keymark.click_point(point="head", pixel=(30.0, 30.0))
    other = tmp_path / "other.mp4"
    other.write_bytes(keypoint_file.with_name("clip.mp4").read_bytes())
    bpy.ops.keymark.load_footage(filepath=str(other))
    follow = active_take(plain).follow
    assert (len(follow.files), len(follow.clicks), follow.use_contours) == (0, 0, False)


def test_another_performer_has_the_same_files_and_no_clicks(
    plain: bpy.types.Scene, keypoint_file: Path
) -> None:
    load(keypoint_file)
    bpy.ops.keymark.click_point(point="head", pixel=(30.0, 30.0))
    assert bpy.ops.keymark.add_performer() == {"FINISHED"}
    follow = active_take(plain).follow
    assert [Path(entry.filepath).name for entry in follow.files] == ["seen.json"]
    assert len(follow.clicks) == 0


def test_what_is_missing_is_said(plain: bpy.types.Scene, keypoint_file: Path) -> None:
    take = active_take(plain)
    assert contours_label(take) == "Camera stands still"
    with pytest.raises(RuntimeError, match="needs more than contours"):
        bpy.ops.keymark.pose_all()
    take.follow.use_contours = False
    with pytest.raises(RuntimeError, match="Switch on the contours, load keypoints"):
        bpy.ops.keymark.reconstruct()
    take.follow.use_contours = True
    take.camera.keyframe_insert("location", frame=1)
    assert contours_label(take) == "Camera moves"
    with pytest.raises(RuntimeError, match="contours need a camera that stands still"):
        bpy.ops.keymark.reconstruct()
    load(keypoint_file)
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}


def test_markers_that_are_switched_off_are_left_out(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    bpy.ops.keymark.add_marker()  # without a color
    with pytest.raises(RuntimeError, match="Pick the colors of all markers"):
        bpy.ops.keymark.reconstruct()
    take.follow.use_markers = False
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
    assert TakeState(active_take(opened)).next[1] == "review, then a character"


@pytest.mark.usefixtures("registered")
def test_the_next_step_goes_on_without_markers(plain_take: Take, keypoint_file: Path) -> None:
    bpy.ops.keymark.load_footage(filepath=str(plain_take.clip))
    scene = bpy.context.scene
    assert TakeState(active_take(scene)).next[1] == "say where the camera stood"
    bpy.ops.keymark.keep_camera()
    assert TakeState(active_take(scene)).next[1] == "choose what to follow"
    take = load(keypoint_file)
    assert TakeState(take).next[1] == "build the actor"
    bpy.ops.keymark.remove_keypoints()
    bpy.ops.keymark.build_actor()
    assert TakeState(active_take(scene)).next[1] == "propose keyframes"
    active_take(scene).follow.use_contours = False
    assert TakeState(active_take(scene)).next[1] == "choose what to follow"


def test_a_dropped_file_of_keypoints_is_loaded(plain: bpy.types.Scene, keypoint_file: Path) -> None:
    assert bpy.ops.keymark.open_dropped(filepath=str(keypoint_file)) == {"FINISHED"}
    assert len(active_take(plain).follow.files) == 1


@pytest.fixture(autouse=True)
def network(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("keymark.core.detect.pose_network.PoseNetwork", MiddleNetwork)


def test_what_is_found_is_written_beside_the_clip_and_listed(
    plain: bpy.types.Scene, plain_take: Take
) -> None:
    theirs = plain_take.folder / "clip.keypoints.json"
    theirs.write_text("theirs", encoding="utf-8")
    for _ in range(2):
        assert bpy.ops.keymark.detect_keypoints() == {"FINISHED"}
    (entry,) = active_take(plain).follow.files
    assert keypoint_path(entry) == plain_take.folder / "clip.keypoints2.json"
    assert theirs.read_text(encoding="utf-8") == "theirs"


def test_a_clip_without_anybody_changes_nothing(
    plain: bpy.types.Scene, plain_take: Take, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(MiddleNetwork, "presence", 0.0)
    before = sorted(plain_take.folder.iterdir())
    with pytest.raises(RuntimeError, match="nobody is seen"):
        bpy.ops.keymark.detect_keypoints()
    assert sorted(plain_take.folder.iterdir()) == before and len(active_take(plain).follow.files) == 0


SWITCHES = ("use_markers", "use_keypoints", "use_depth_hints", "use_contours")


def test_keypoints_go_out_with_a_take_and_come_back(
    plain: bpy.types.Scene, keypoint_file: Path, tmp_path: Path
) -> None:
    bpy.ops.keymark.load_keypoints(filepath=str(keypoint_file))
    bpy.ops.keymark.click_point(point="nose", pixel=(80.0, 30.0))
    track = active_take(plain).clip.tracking.tracks.new(name="wrist.L", frame=1)
    track.markers[0].co = (0.5, 0.5)
    folder = tmp_path / "saved"
    assert bpy.ops.keymark.save_take(directory=str(folder)) == {"FINISHED"}
    saved = read_take(folder)
    assert sorted(people.names[0] for people in saved.keypoints) == ["head", "nose", "wrist.L"]
    assert saved.markers == () and saved.contours
    assert bpy.ops.keymark.open_take(filepath=str(folder)) == {"FINISHED"}
    follow = active_take(plain).follow
    assert len(follow.files) == 3 and all(getattr(follow, name) for name in SWITCHES)


def test_switches_go_out_with_a_take_and_come_back(opened: bpy.types.Scene, tmp_path: Path) -> None:
    active_take(opened).follow.use_contours = False
    folder = tmp_path / "saved"
    bpy.ops.keymark.save_take(directory=str(folder))
    assert describe(folder).settings.evidence == ("markers",)
    bpy.ops.keymark.open_take(filepath=str(folder))
    follow = active_take(opened).follow
    assert follow.use_markers and not follow.use_contours


def test_a_take_that_leaves_its_markers_aside_opens_with_them_switched_off(
    registered: None, tiny_take: Take
) -> None:
    file = tiny_take.folder / "take.json"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("{", '{"evidence": ["contours"], ', 1), encoding="utf-8")
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder))
    take = active_take(bpy.context.scene)
    assert len(take.markers) == 5
    assert [getattr(take.follow, name) for name in SWITCHES] == [False, False, False, True]


def test_a_take_whose_keypoints_are_gone_is_refused(registered: None, plain_take: Take) -> None:
    file = plain_take.folder / "take.json"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("{", '{"keypoints": "no.json", ', 1), encoding="utf-8")
    with pytest.raises(RuntimeError, match=r"no\.json"):
        bpy.ops.keymark.open_take(filepath=str(plain_take.folder))
    assert len(bpy.context.scene.keymark.takes) == 0
