"""The animator's keyframes."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.prior.keyframes import Keyframe
from keymark.core.take.motion import Motion
from keymark.operators.bridge.actions import assign_action
from keymark.operators.bridge.fcurves import write_motion
from keymark.operators.bridge.keyframes import keyed_frames, read_keyframes, store_pose, write_keyframes
from keymark.operators.bridge.pose import write_posture

CLIP = np.arange(1.0, 31.0)


@pytest.fixture
def action() -> bpy.types.Action:
    return bpy.data.actions.new("Keyframes")


@pytest.fixture
def postures(random_posture: Callable[[int], Posture]) -> tuple[Keyframe, ...]:
    return tuple(Keyframe(index, random_posture(50 + index)) for index in (0, 11, 29))


def test_written_keyframes_are_read_back(
    actor: bpy.types.Object, body: Body, action: bpy.types.Action, postures: tuple[Keyframe, ...]
) -> None:
    write_keyframes(actor, action, postures, CLIP)
    found = read_keyframes(bpy.context.scene, actor, action, body, CLIP)
    assert found.notes == ()
    assert [keyframe.index for keyframe in found.keyframes] == [0, 11, 29]
    for read, written in zip(found.keyframes, postures, strict=True):
        assert read.posture.minus(written.posture) == pytest.approx(0.0, abs=1e-5)
        assert read.residual_m < 1e-5


def test_stored_poses_are_keyframes_and_storing_again_replaces(
    actor: bpy.types.Object, body: Body, action: bpy.types.Action, random_posture: Callable[[int], Posture]
) -> None:
    write_posture(actor, random_posture(60))
    store_pose(actor, action, 5.0)
    write_posture(actor, random_posture(61))
    store_pose(actor, action, 5.0)
    (keyframe,) = read_keyframes(bpy.context.scene, actor, action, body, CLIP).keyframes
    assert keyframe.index == 4
    assert keyframe.posture.minus(random_posture(61)) == pytest.approx(0.0, abs=1e-5)


def test_keys_that_were_generated_or_are_of_hands_alone_are_no_keyframes(
    actor: bpy.types.Object, wave_motion: Motion
) -> None:
    action = write_motion(actor, wave_motion)
    actor.pose.bones["hand.L"].keyframe_insert("rotation_quaternion", frame=9)
    assert keyed_frames(actor, action) == ()
    store_pose(actor, action, 4.0)
    assert keyed_frames(actor, action) == (4.0,)


def test_keys_outside_the_footage_are_left_out_and_named(
    actor: bpy.types.Object, body: Body, action: bpy.types.Action, postures: tuple[Keyframe, ...]
) -> None:
    write_keyframes(actor, action, postures, CLIP)
    store_pose(actor, action, -10.0)
    found = read_keyframes(bpy.context.scene, actor, action, body, CLIP)
    assert len(found.keyframes) == 3
    assert found.notes == ("Keys at -10 lie outside the footage and are not used",)


def test_a_key_goes_to_the_frame_of_an_uneven_clip_that_lies_nearest(
    actor: bpy.types.Object, body: Body, action: bpy.types.Action
) -> None:
    store_pose(actor, action, 4.0)
    uneven = np.array([1.0, 2.1, 3.8, 5.2])
    (keyframe,) = read_keyframes(bpy.context.scene, actor, action, body, uneven).keyframes
    assert keyframe.index == 2


def test_a_pose_beyond_the_freedoms_is_noted(
    actor: bpy.types.Object, body: Body, action: bpy.types.Action
) -> None:
    actor.pose.bones["forearm.L"].rotation_euler = (0.4, 0.0, 0.5)
    store_pose(actor, action, 3.0)
    found = read_keyframes(bpy.context.scene, actor, action, body, CLIP)
    assert len(found.notes) == 1
    assert "Keyframe 3: the pose goes" in found.notes[0]
    assert found.keyframes[0].residual_m > 1e-3


def test_reading_leaves_frame_action_and_unkeyed_pose_as_they_were(
    actor: bpy.types.Object,
    body: Body,
    action: bpy.types.Action,
    wave_motion: Motion,
    postures: tuple[Keyframe, ...],
) -> None:
    scene = bpy.context.scene
    motion_action = write_motion(actor, wave_motion)
    write_keyframes(actor, action, postures, CLIP)
    scene.frame_set(7, subframe=0.5)
    actor.pose.bones["chest"].rotation_quaternion = (0.8, 0.0, 0.6, 0.0)
    read_keyframes(scene, actor, action, body, CLIP)
    bpy.context.view_layer.update()
    assert (scene.frame_current, scene.frame_subframe) == (7, 0.5)
    assert actor.animation_data.action == motion_action
    assert actor.animation_data.action_slot == motion_action.slots[0]
    assert tuple(actor.pose.bones["chest"].rotation_quaternion) == pytest.approx((0.8, 0.0, 0.6, 0.0))


def test_reading_the_action_in_use_leaves_the_unkeyed_pose(
    actor: bpy.types.Object, body: Body, action: bpy.types.Action, postures: tuple[Keyframe, ...]
) -> None:
    write_keyframes(actor, action, postures, CLIP)
    assign_action(actor, action)
    bpy.context.scene.frame_set(12)
    actor.pose.bones["chest"].rotation_quaternion = (0.8, 0.0, 0.6, 0.0)
    read_keyframes(bpy.context.scene, actor, action, body, CLIP)
    bpy.context.view_layer.update()
    assert tuple(actor.pose.bones["chest"].rotation_quaternion) == pytest.approx((0.8, 0.0, 0.6, 0.0))
