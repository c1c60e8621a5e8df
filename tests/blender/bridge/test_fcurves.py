"""Motions as F-curves: slots, key types, and the animator's own keys."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.take.motion import Motion
from keymark.operators.bridge.actions import curves_of
from keymark.operators.bridge.fcurves import write_motion
from mathutils import Euler, Matrix, Vector

CHANNELS = 7 + 4 * 6 + 3 * 6 + 4 * 4
"""Pelvis: 3 + 4. Chest, head, 2 upper arms, 2 thighs are balls; 2 girdles, forearms, shins have angles."""


FOREARM = ('pose.bones["forearm.L"].rotation_euler', 0)


@pytest.fixture
def action(actor: bpy.types.Object, wave_motion: Motion) -> bpy.types.Action:
    return write_motion(actor, wave_motion)


def key_count(action: bpy.types.Action) -> int:
    return sum(len(curve.keyframe_points) for curve in curves_of(action).values())


@pytest.mark.usefixtures("action")
def test_every_frame_shows_the_motion(
    actor: bpy.types.Object, wave_motion: Motion, shown_points: Callable[[bpy.types.Object], np.ndarray]
) -> None:
    for frame, points in zip(wave_motion.scene_frames, wave_motion.points, strict=True):
        bpy.context.scene.frame_set(int(frame))
        assert shown_points(actor) == pytest.approx(points, abs=1e-5)


def test_a_placed_and_scaled_actor_shows_the_same_places(
    actor: bpy.types.Object, body: Body, wave_motion: Motion
) -> None:
    actor.matrix_world = Matrix.LocRotScale(Vector((1, 2, 0)), Euler((0.1, 0.2, 0.3)), Vector((0.8,) * 3))
    write_motion(actor, wave_motion)
    bpy.context.scene.frame_set(7)
    pelvis = actor.matrix_world @ actor.pose.bones["pelvis"].head
    assert np.array(pelvis) == pytest.approx(wave_motion.posture.translation[6], abs=1e-5)


def test_the_action_has_a_slot_groups_and_one_generated_key_a_frame(
    actor: bpy.types.Object, wave_motion: Motion, action: bpy.types.Action
) -> None:
    assert actor.animation_data.action == action
    assert actor.animation_data.action_slot == action.slots[0]
    found = curves_of(action)
    assert len(found) == CHANNELS
    assert {len(curve.keyframe_points) for curve in found.values()} == {len(wave_motion.time_s)}
    assert all(f'"{curve.group.name}"' in path for (path, _), curve in found.items())
    points = found['pose.bones["shin.L"].rotation_euler', 0].keyframe_points
    assert {(point.type, point.interpolation) for point in points} == {("GENERATED", "LINEAR")}
    assert [point.co.x for point in points] == pytest.approx(wave_motion.scene_frames)
    knee = wave_motion.posture.to_vector()[:, HUMAN.dof_names.index("knee.L.flexion")]
    assert [point.co.y for point in points] == pytest.approx(knee, abs=1e-6)


def test_a_second_run_replaces_generated_keys_only(
    actor: bpy.types.Object, wave_motion: Motion, action: bpy.types.Action
) -> None:
    before = key_count(action)
    curve = curves_of(action)[FOREARM]
    own = curve.keyframe_points.insert(5.0, 1.25)
    own.type, own.interpolation = "KEYFRAME", "BEZIER"
    own.handle_left_type = own.handle_right_type = "FREE"
    own.handle_right = (5.3, 2.0)
    curve.keyframe_points.insert(9.5, 1.5).type = "EXTREME"
    actor["mood"] = 1.0
    actor.keyframe_insert('["mood"]', frame=3)
    assert write_motion(actor, wave_motion, action) == action
    points = curves_of(action)[FOREARM].keyframe_points
    kept = next(point for point in points if point.co.x == 5.0)
    assert (kept.type, kept.interpolation, kept.co.y) == ("KEYFRAME", "BEZIER", 1.25)
    assert tuple(kept.handle_right) == pytest.approx((5.3, 2.0))
    assert next(point.type for point in points if point.co.x == 9.5) == "EXTREME"
    assert ('["mood"]', 0) in curves_of(action)
    assert key_count(action) == before + 2  # the key at 5 stands in for a generated one


def test_a_generated_key_that_was_keyed_over_is_the_animators(
    actor: bpy.types.Object, wave_motion: Motion, action: bpy.types.Action
) -> None:
    bone = actor.pose.bones["forearm.L"]
    bone.rotation_euler.x = 1.25
    bone.keyframe_insert("rotation_euler", index=0, frame=5)
    for _ in range(2):
        write_motion(actor, wave_motion, action)
        points = curves_of(action)[FOREARM].keyframe_points
        assert [point.co[:] for point in points if point.type == "KEYFRAME"] == [(5.0, 1.25)]


def test_a_shorter_second_run_in_another_rotation_mode_leaves_nothing_stale(
    actor: bpy.types.Object, wave_motion: Motion, action: bpy.types.Action
) -> None:
    shorter = wave_motion.emptied(np.arange(len(wave_motion.time_s)) < 5)
    write_motion(actor, shorter, action)
    assert key_count(action) == CHANNELS * 5
    actor.pose.bones["thigh.L"].rotation_mode = "XYZ"
    write_motion(actor, shorter, action)
    channels = {path for path, _ in curves_of(action) if '"thigh.L"' in path}
    assert channels == {'pose.bones["thigh.L"].rotation_euler'}


def test_hands_move_as_the_animator_keyed_them(actor: bpy.types.Object, wave_motion: Motion) -> None:
    hand = actor.pose.bones["hand.R"]
    hand.keyframe_insert("rotation_quaternion", frame=1)
    hand.rotation_quaternion = (0.6, 0.8, 0.0, 0.0)
    hand.keyframe_insert("rotation_quaternion", frame=13)
    actor.pose.bones["head"].keyframe_insert("scale", frame=1)
    posed = actor.animation_data.action
    action = write_motion(actor, wave_motion, keyframe_action=posed)
    assert action != posed
    bpy.context.scene.frame_set(13)
    assert tuple(hand.rotation_quaternion) == pytest.approx((0.6, 0.8, 0.0, 0.0), abs=1e-6)
    assert not any("scale" in path for path, _ in curves_of(action))
    write_motion(actor, wave_motion, action, posed)
    found = curves_of(action)
    assert len(found) == CHANNELS
    keys = found['pose.bones["hand.R"].rotation_quaternion', 1].keyframe_points
    assert [key.co.x for key in keys] == [1.0, 13.0]
    assert len(found['pose.bones["hand.L"].rotation_quaternion', 1].keyframe_points) == len(
        wave_motion.time_s
    )


def test_hands_corrected_in_the_motion_stay_when_it_is_written_again(
    actor: bpy.types.Object, wave_motion: Motion
) -> None:
    hand = actor.pose.bones["hand.R"]
    hand.rotation_quaternion = (0.8, 0.6, 0.0, 0.0)
    for frame in (1, 13):
        hand.keyframe_insert("rotation_quaternion", frame=frame)
    posed = actor.animation_data.action
    action = write_motion(actor, wave_motion, keyframe_action=posed)
    hand.rotation_quaternion = (0.6, 0.8, 0.0, 0.0)
    for frame in (5, 13):
        hand.keyframe_insert("rotation_quaternion", frame=frame)
    write_motion(actor, wave_motion, action, posed)
    curve = curves_of(action)['pose.bones["hand.R"].rotation_quaternion', 1]
    assert [key.co.x for key in curve.keyframe_points] == [1.0, 5.0, 13.0]
    assert [key.co.y for key in curve.keyframe_points] == pytest.approx([0.6, 0.8, 0.8])


def test_fractional_frames_of_an_uneven_clip_are_kept(actor: bpy.types.Object, wave_motion: Motion) -> None:
    frames = wave_motion.scene_frames + 0.25
    found = curves_of(write_motion(actor, wave_motion, frames=frames))
    points = found['pose.bones["pelvis"].location', 2].keyframe_points
    assert [point.co.x for point in points] == pytest.approx(frames)
