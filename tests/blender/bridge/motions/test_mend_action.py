"""Actions of any armature, mended on it: steadier, corrected where a person set keys, the rest untouched."""

import bpy
import numpy as np
import pytest
from _performances import jitter_mm
from keymark.core.arrays import Array
from keymark.core.errors import InputError
from keymark.core.progress import run
from keymark.core.retarget.mended_armature import ArmaturePoints
from keymark.core.retarget.solve.rest_body import RestBody
from keymark.operators.bridge.actions import existing_channelbag
from keymark.operators.bridge.character.read_character import read_character
from keymark.operators.bridge.motions.mend_action import SOURCE, mend_action, write_mended
from keymark.operators.bridge.motions.read_poses import (
    action_frames,
    joint_paths,
    motion_map,
    posed_frames,
    read_poses,
)


def mended(armature: bpy.types.Object, *named: int) -> bpy.types.Action:
    """The Action that mending gives the armature."""
    return write_mended(armature, run(mend_action(armature, motion_map(armature, ()).character_map, named)))


def joints(armature: bpy.types.Object, action: bpy.types.Action) -> Array:
    """(F, 13, 3) the points that an Action shows."""
    points = ArmaturePoints.of(RestBody.of(read_character(armature), motion_map(armature, ()).character_map))
    frames = action_frames(armature, action)
    poses, _ = run(read_poses(armature, action, frames, tuple(dict.fromkeys(points.bones))))
    return points.of_poses(poses)


def curves(armature: bpy.types.Object, action: bpy.types.Action, bone: str) -> list[list[float]]:
    """The keys of a bone."""
    bag = existing_channelbag(action, armature)
    return [
        [value for key in curve.keyframe_points for value in key.co]
        for curve in bag.fcurves
        if f'"{bone}"' in curve.data_path
    ]


def test_the_motion_is_steady_and_fingers_and_toes_are_as_before(shaken: bpy.types.Object) -> None:
    given = shaken.animation_data.action
    before = joints(shaken, given)
    made = mended(shaken)
    assert shaken.animation_data.action == made != given and made[SOURCE] == given
    after = joints(shaken, made)
    assert jitter_mm(after) < 0.35 * jitter_mm(before)
    for bone in ("finger.L", "toe.L"):
        assert curves(shaken, made, bone) == curves(shaken, given, bone) != []
    assert curves(shaken, made, "forearm.L") != curves(shaken, given, "forearm.L")
    shin = np.linalg.norm(after[:, 9] - after[:, 11], axis=-1)
    assert np.ptp(shin) < 1e-5
    np.testing.assert_allclose(joints(shaken, given), before, atol=1e-9)


def test_a_frame_that_a_person_posed_afterwards_stays_and_moves_those_beside_it(
    shaken: bpy.types.Object,
) -> None:
    first = mended(shaken)
    before = joints(shaken, first)
    assert posed_frames(shaken, first, ("upper_arm.L",), np.arange(1.0, 46.0)) == ()
    bpy.context.scene.frame_set(20)
    bone = shaken.pose.bones["upper_arm.L"]
    bone.rotation_quaternion = bone.rotation_quaternion @ type(bone.rotation_quaternion)((1.0, 0.0, 0.0), 0.6)
    bone.keyframe_insert("rotation_quaternion", frame=20)
    posed = joints(shaken, first)
    second = mended(shaken)
    after = joints(shaken, second)
    assert posed_frames(shaken, second, ("upper_arm.L",), np.arange(1.0, 46.0)) == (19,)
    assert second[SOURCE].name == "Network"
    elbow, ankle = 3, 12
    moved = np.linalg.norm(after[:, elbow] - before[:, elbow], axis=-1)
    assert np.linalg.norm(posed[19, elbow] - before[19, elbow]) > 0.05
    assert np.linalg.norm(after[19, elbow] - posed[19, elbow]) < 0.02
    assert moved[17] > 0.5 * moved[19] and moved[40] < 0.5 * moved[19]
    assert np.linalg.norm(after[:, ankle] - before[:, ankle], axis=-1).max() < 0.02
    assert jitter_mm(after) < 2.0 * jitter_mm(before)


def test_frames_may_be_named_and_a_motion_keyed_by_hand_is_no_pose(shaken: bpy.types.Object) -> None:
    bag = existing_channelbag(shaken.animation_data.action, shaken)
    for curve in bag.fcurves:
        for key in curve.keyframe_points:
            key.type = "KEYFRAME"
    action = shaken.animation_data.action
    assert posed_frames(shaken, action, ("upper_arm.L",), np.arange(1.0, 46.0)) == ()
    found = run(mend_action(shaken, motion_map(shaken, ()).character_map, (12, 30)))
    assert found.posed == (11, 29)
    with pytest.raises(InputError, match="posed frame 90 is not in Action 'Network'; its frames are 1 to 45"):
        mended(shaken, 90)


def test_an_armature_that_something_else_moves_is_refused_and_unchanged(shaken: bpy.types.Object) -> None:
    target = bpy.data.objects.new("Target", None)
    bpy.context.scene.collection.objects.link(target)
    target.location = (0.0, 0.0, 3.0)
    follows = shaken.pose.bones["forearm.L"].constraints.new("DAMPED_TRACK")
    follows.target = target
    action = shaken.animation_data.action
    count = len(bpy.data.actions)
    with pytest.raises(InputError, match="moved by constraints, drivers or controls"):
        mended(shaken)
    assert shaken.animation_data.action == action and len(bpy.data.actions) == count


def test_what_has_no_motion_is_refused(shaken: bpy.types.Object) -> None:
    character_map = motion_map(shaken, ()).character_map
    bag = existing_channelbag(shaken.animation_data.action, shaken)
    for curve in bag.fcurves:
        while len(curve.keyframe_points) > 1:
            curve.keyframe_points.remove(curve.keyframe_points[-1])
    with pytest.raises(InputError, match="over 1 frames; 3 to"):
        run(mend_action(shaken, character_map))
    shaken.animation_data.action = None
    with pytest.raises(InputError, match="has no Action"):
        run(mend_action(shaken, character_map))


def test_joints_of_any_armature_are_told_for_files_of_points(shaken: bpy.types.Object) -> None:
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 3, 9
    points, rate = joint_paths(shaken)
    assert points.shape == (7, 13, 3) and rate == 30.0
    np.testing.assert_allclose(points, joints(shaken, shaken.animation_data.action)[2:9], atol=1e-9)
