"""Keyframes that matching gave: they count as matched until the animator touches them."""

from collections.abc import Callable
from dataclasses import replace

import bpy
import numpy as np
import pytest
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.prior.keyframes import Keyframe, Matched
from keymark.core.progress import run
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take, write_take
from keymark.operators.bridge import take_from_scene
from keymark.operators.bridge.actions import existing_channelbag
from keymark.operators.bridge.armature import read_body
from keymark.operators.bridge.keyframes import (
    keyed_frames,
    read_keyframes,
    remove_keyframes,
    store_pose,
    take_over,
    unchanged_keyframes,
    write_matched,
)
from keymark.operators.bridge.keys import FOUND, keys_changed
from keymark.operators.bridge.pose import read_posture
from keymark.operators.bridge.take_from_scene import read_scene_take
from keymark.operators.follow.evidence import scene_evidence
from keymark.operators.keyframes.found_properties import known_matches
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take, footage_of

pytestmark = pytest.mark.usefixtures("registered")

MATCHED = Matched("walking", "Contact Left", True, 0.625)


@pytest.fixture
def matched_take(tiny_take: Take) -> Take:
    first, middle, last = tiny_take.keyframes
    take = replace(tiny_take, keyframes=(first, replace(middle, matched=MATCHED), last))
    write_take(take, tiny_take.folder)
    return take


@pytest.fixture
def take(matched_take: Take) -> bpy.types.PropertyGroup:
    bpy.ops.keymark.open_take(filepath=str(matched_take.folder / "take.json"))
    return active_take(bpy.context.scene)


def keyframes_in(take: bpy.types.PropertyGroup) -> tuple[Keyframe, ...]:
    """The keyframes that a reconstruction is given."""
    scene = bpy.context.scene
    reading = read_scene_take(
        footage_of(scene, take),
        take.armature,
        take.keyframe_action,
        scene_evidence(take),
        known_matches(take),
    )
    return run(reading)[0].keyframes


def matched_in(take: bpy.types.PropertyGroup) -> list[Matched | None]:
    return [keyframe.matched for keyframe in keyframes_in(take)]


def key_at(take: bpy.types.PropertyGroup, path: str, index: int, frame: float) -> bpy.types.Keyframe:
    curve = existing_channelbag(take.keyframe_action, take.armature).fcurves.find(path, index=index)
    return next(key for key in curve.keyframe_points if key.co[0] == frame)


def test_a_take_with_matched_keyframes_is_opened_and_saved_as_it_was(
    take: bpy.types.PropertyGroup, matched_take: Take
) -> None:
    assert TakeState(take).keyed.all == (1.0, 7.0, 13.0)
    assert (TakeState(take).matched, TakeState(take).posed) == ((7.0,), (1.0, 13.0))
    bpy.ops.keymark.save_take(directory=str(matched_take.folder / "again"))
    again = read_take(matched_take.folder / "again")
    assert [keyframe.matched for keyframe in again.keyframes] == [None, MATCHED, None]
    for after, before in zip(again.keyframes, matched_take.keyframes, strict=True):
        assert after.posture.minus(before.posture) == pytest.approx(0.0, abs=1e-5)


def test_matches_survive_the_blend_file(take: bpy.types.PropertyGroup, matched_take: Take) -> None:
    file = str(matched_take.folder / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    assert matched_in(active_take(bpy.context.scene)) == [None, MATCHED, None]


def test_a_correction_in_the_picture_is_kept_by_files_until_someone_changes_it(
    take: bpy.types.PropertyGroup, matched_take: Take
) -> None:
    bpy.context.scene.frame_set(7)
    store_pose(take.armature, take.keyframe_action, 7.0, depth_found=True)
    assert [keyframe.depth_found for keyframe in keyframes_in(take)] == [False, True, False]
    bpy.ops.keymark.save_take(directory=str(matched_take.folder / "again"))
    again = read_take(matched_take.folder / "again")
    assert [keyframe.depth_found for keyframe in again.keyframes] == [False, True, False]
    bpy.ops.keymark.open_take(filepath=str(matched_take.folder / "again" / "take.json"))
    file = str(matched_take.folder / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    opened = active_take(bpy.context.scene)
    assert [keyframe.depth_found for keyframe in keyframes_in(opened)] == [False, True, False]
    key_at(opened, 'pose.bones["forearm.L"].rotation_euler', 0, 7.0).co[1] += 0.01
    assert not any(keyframe.depth_found for keyframe in keyframes_in(opened))


def test_a_changed_key_makes_the_keyframe_posed(take: bpy.types.PropertyGroup) -> None:
    key = key_at(take, 'pose.bones["forearm.L"].rotation_euler', 0, 7.0)
    before = key.co[1]
    key.co[1] += 0.01
    assert matched_in(take) == [None, None, None]
    key.co[1] = before
    assert matched_in(take) == [None, MATCHED, None]


def keyed_by_blender(take: bpy.types.PropertyGroup) -> None:
    bone = take.armature.pose.bones["chest"]
    bone.rotation_quaternion = (0.9, 0.3, 0.2, 0.1)
    bone.keyframe_insert("rotation_quaternion", frame=7)


def turned_another_way(take: bpy.types.PropertyGroup) -> None:
    take.armature.pose.bones["chest"].rotation_mode = "XYZ"


def stored(take: bpy.types.PropertyGroup) -> None:
    bpy.ops.keymark.store_keyframe()
    assert key_at(take, 'pose.bones["chest"].rotation_quaternion', 0, 7.0).type == "KEYFRAME"


@pytest.mark.parametrize("change", [keyed_by_blender, turned_another_way, stored])
def test_what_an_animator_does_at_the_frame_makes_it_posed(
    take: bpy.types.PropertyGroup, change: Callable[[bpy.types.PropertyGroup], None]
) -> None:
    bpy.context.scene.frame_set(7)
    change(take)
    assert matched_in(take) == [None, None, None]


def test_a_keyframe_moved_to_another_frame_is_posed_there(take: bpy.types.PropertyGroup) -> None:
    for curve in existing_channelbag(take.keyframe_action, take.armature).fcurves:
        for key in curve.keyframe_points:
            if key.co[0] == 7.0:
                key.co_ui[0] = 9.0
        curve.update()
    found = keyframes_in(take)
    assert [(keyframe.index, keyframe.matched) for keyframe in found] == [(0, None), (8, None), (12, None)]


def test_other_lengths_leave_matches_as_they_are(take: bpy.types.PropertyGroup) -> None:
    take.lengths.forearm_L *= 1.05
    bpy.ops.keymark.apply_lengths()
    assert matched_in(take) == [None, MATCHED, None]


def test_matched_keyframes_are_taken_over_and_removed(take: bpy.types.PropertyGroup) -> None:
    armature_object, action = take.armature, take.keyframe_action
    before = read_at(take, 7)
    take_over(armature_object, action, (7.0,))
    assert unchanged_keyframes(armature_object, action, FOUND) == ()
    assert read_at(take, 7).minus(before) == pytest.approx(0.0, abs=1e-6)
    key = key_at(take, 'pose.bones["chest"].rotation_quaternion', 0, 7.0)
    assert key.type == "KEYFRAME" and key.amplitude != FOUND.amplitude
    remove_keyframes(armature_object, action, (7.0,))
    keys_changed()
    assert keyed_frames(armature_object, action) == TakeState(take).keyed.all == (1.0, 13.0)


def test_removing_all_keyframes_leaves_keys_of_the_hands(take: bpy.types.PropertyGroup) -> None:
    armature_object, action = take.armature, take.keyframe_action
    store_pose(armature_object, action, 7.0)
    remove_keyframes(armature_object, action, (1.0, 7.0, 13.0))
    left = {curve.data_path for curve in existing_channelbag(action, armature_object).fcurves}
    assert left == {
        f'pose.bones["{bone}"].rotation_quaternion' for bone in ("hand.L", "hand.R", "foot.L", "foot.R")
    }


def test_matched_postures_between_posed_ones_do_not_turn_the_long_way_round(
    take: bpy.types.PropertyGroup, random_posture: Callable[[int], Posture]
) -> None:
    armature_object, action = take.armature, take.keyframe_action
    bag = existing_channelbag(action, armature_object)
    curves = [bag.fcurves.find('pose.bones["pelvis"].rotation_quaternion', index=i) for i in range(4)]
    for curve in curves:
        for key in curve.keyframe_points:
            key.co[1] *= -1.0
        curve.update()
    posture = random_posture(3)
    write_matched(armature_object, action, np.array([4.0]), [posture])
    beside = np.array([[curve.evaluate(frame) for curve in curves] for frame in (1.0, 4.0)])
    assert beside[0] @ beside[1] > 0.0
    body_keyframes = read_keyframes(
        bpy.context.scene, armature_object, action, body_of(take), np.arange(1.0, 14.0)
    )
    assert body_keyframes.keyframes[1].posture.minus(posture) == pytest.approx(0.0, abs=1e-5)


def body_of(take: bpy.types.PropertyGroup) -> Body:
    return read_body(take.armature)


def read_at(take: bpy.types.PropertyGroup, frame: int) -> Posture:
    bpy.context.scene.frame_set(frame)
    return read_posture(take.armature, body_of(take)).posture


def test_a_pose_is_fitted_with_markers_as_posed_frames_show_them(
    take: bpy.types.PropertyGroup, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []
    original = take_from_scene.calibrated

    def calibrated(model, seen, posture, frames, *keypoints):  # noqa: ANN001, ANN002, ANN202
        asked.append(len(frames))
        return original(model, seen, posture, frames, *keypoints)

    monkeypatch.setattr(take_from_scene, "calibrated", calibrated)
    bpy.ops.keymark.propose_keyframes()  # reads the clip
    bpy.context.scene.frame_set(4)
    assert bpy.ops.keymark.fit_pose() == {"FINISHED"}
    take_over(take.armature, take.keyframe_action, (7.0,))
    assert bpy.ops.keymark.fit_pose() == {"FINISHED"}
    assert asked == [2, 3]
