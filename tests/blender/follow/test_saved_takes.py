"""Takes on disk with keypoints and switches: opened into a scene, and saved from it."""

from pathlib import Path

import bpy
import pytest
from keymark.core.take.description import describe
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take
from keymark.operators.shell.takes import active_take

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
