"""Feet and hands of motions in Blender: as computed on any actor, replaced anew, the animator's kept."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from keymark.core.body.fingers import Hands
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body, extremity_names, segment_motion
from keymark.core.body.posture import Posture
from keymark.core.feet.natural_extremities import natural_extremities
from keymark.core.progress import run
from keymark.core.take.motion import Motion
from keymark.operators.bridge.actions import assign_action, existing_channelbag
from keymark.operators.bridge.armature import build_armature, read_body
from keymark.operators.bridge.fcurves import (
    posed_extremities,
    straighten_extremities,
    turned_extremities,
    write_motion,
)
from keymark.operators.bridge.finish_motion import Finished, FinishOptions, finish_motion
from keymark.operators.bridge.keyframes import store_pose
from mathutils import Euler, Matrix, Vector

FRAMES, FPS = 60, 30.0


@pytest.fixture
def actor(body: Body) -> bpy.types.Object:
    armature_object = build_armature(bpy.context.scene, body)
    armature_object.matrix_world = Matrix.LocRotScale(
        Vector((0.3, -0.5, 0.2)), Euler((0.1, 0.2, 0.3)), Vector((1.1,) * 3)
    )
    for bone, mode in (("foot.L", "XYZ"), ("foot.R", "AXIS_ANGLE"), ("shin.L", "QUATERNION")):
        armature_object.pose.bones[bone].rotation_mode = mode
    bpy.context.view_layer.update()
    return armature_object


def swaying(armature_object: bpy.types.Object) -> Motion:
    """A motion that stands, bends its knees and sways a little, the ankles in their places but for noise."""
    body = read_body(armature_object)
    time = np.arange(FRAMES) / FPS
    bend = 0.35 - 0.3 * np.cos(3.0 * time)
    vector = np.zeros((FRAMES, HUMAN.dof_count))
    legs = body.actor.segments_m["thigh.L"], body.actor.segments_m["shin.L"]
    vector[:, 2] = 0.08 + (legs[0] + legs[1]) * np.cos(bend)
    vector[:, 0] = 0.004 * np.sin(5.0 * time)
    for side in ("L", "R"):
        vector[:, HUMAN.dof_names.index(f"hip.{side}.rotation_x")] = -bend
        vector[:, HUMAN.dof_names.index(f"knee.{side}.flexion")] = 2.0 * bend
    posture = Posture.from_vector(HUMAN, vector)
    points = body.points(body.pose(posture))
    covariance = np.broadcast_to(1e-4 * np.eye(3), (FRAMES, 13, 3, 3))
    return Motion(body, FPS, 1, time, posture, points, covariance, (0,), "map")


def shown_tip(armature_object: bpy.types.Object, bone: str) -> np.ndarray:
    """The world position of a bone's tail, as Blender shows it now."""
    shown = armature_object.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return np.array(shown.matrix_world @ shown.pose.bones[bone].tail)


def tips(armature_object: bpy.types.Object) -> np.ndarray:
    """(F, 4, 3) tips of hands and feet in every frame."""
    found = []
    for frame in range(1, FRAMES + 1):
        bpy.context.scene.frame_set(frame)
        found.append([shown_tip(armature_object, name) for name in extremity_names(HUMAN)])
    return np.array(found)


def curve(armature_object: bpy.types.Object, action: bpy.types.Action, bone: str) -> bpy.types.FCurve:
    """The curve of a bone's second quaternion channel."""
    path = f'pose.bones["{bone}"].rotation_quaternion'
    return existing_channelbag(action, armature_object).fcurves.find(path, index=1)


def final_action(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    options: FinishOptions,
    keyframes: bpy.types.Action | None = None,
) -> tuple[Finished, bpy.types.Action]:
    """A motion finished, and the Action that holds it."""
    finished = run(finish_motion(armature_object, action, keyframes, options, 1.0 / FPS))
    final = bpy.data.actions.new("Final")
    finished.write(armature_object, action, final)
    return finished, final


def test_blender_shows_what_was_computed(actor: bpy.types.Object) -> None:
    motion = swaying(actor)
    write_motion(actor, motion)
    natural = natural_extremities(motion.body, motion.posture, motion.time_s)
    wanted = segment_motion(motion.body, motion.posture, motion.time_s, natural).end
    expected = np.stack([wanted[name] for name in extremity_names(HUMAN)], axis=1)
    assert tips(actor) == pytest.approx(expected, abs=1e-5)


def test_written_again_only_what_is_keymarks_is_replaced(actor: bpy.types.Object) -> None:
    motion = swaying(actor)
    action = write_motion(actor, motion)
    keys = len(curve(actor, action, "hand.L").keyframe_points)
    actor.pose.bones["hand.L"].rotation_quaternion = (0.8, 0.6, 0.0, 0.0)
    actor.pose.bones["hand.L"].keyframe_insert("rotation_quaternion", frame=20)
    write_motion(actor, motion, action)
    points = curve(actor, action, "hand.L").keyframe_points
    assert len(points) == keys == FRAMES
    assert points[19].co.y == pytest.approx(0.6) and points[19].type == "KEYFRAME"
    assert {point.type for point in points if point.co.x != 20.0} == {"GENERATED"}


def test_hands_and_feet_keyed_at_rest_are_not_posed(actor: bpy.types.Object) -> None:
    keyframes = bpy.data.actions.new("Keyframes")
    actor.pose.bones["foot.L"].rotation_euler = (0.2, 0.0, 0.0)
    store_pose(actor, keyframes, 1.0)
    assert posed_extremities(actor, keyframes) == {"foot.L"}
    action = write_motion(actor, swaying(actor), keyframe_action=keyframes)
    assert set(turned_extremities(actor, action, keyframes)) == {"foot.R", "hand.L", "hand.R"}


def test_a_shown_motions_hands_and_feet_are_not_stored(actor: bpy.types.Object) -> None:
    action = write_motion(actor, swaying(actor))
    bpy.context.scene.frame_set(20)
    actor.pose.bones["hand.R"].rotation_quaternion = (0.8, 0.6, 0.0, 0.0)
    assert tuple(actor.pose.bones["hand.L"].rotation_quaternion) != (1.0, 0.0, 0.0, 0.0)
    straighten_extremities(actor, action, None, 20.0)
    assert tuple(actor.pose.bones["hand.L"].rotation_quaternion) == (1.0, 0.0, 0.0, 0.0)
    assert tuple(actor.pose.bones["foot.L"].rotation_euler) == (0.0, 0.0, 0.0)
    keyframes = bpy.data.actions.new("Keyframes")
    store_pose(actor, keyframes, 20.0)
    assert posed_extremities(actor, keyframes) == {"hand.R"}


@pytest.mark.parametrize("tolerance_m", [None, 0.01])
def test_planted_soles_lie_flat_and_still_in_blender(
    actor: bpy.types.Object, tolerance_m: float | None
) -> None:
    action = write_motion(actor, swaying(actor))
    finished, final = final_action(actor, action, FinishOptions(tolerance_m, False, 0.05))
    assert {contact.point for contact in finished.contacts} == {0, 1}
    assign_action(actor, final)
    feet = tips(actor)[:, [extremity_names(HUMAN).index(f"foot.{side}") for side in ("L", "R")]]
    for contact in finished.contacts:
        tip = feet[contact.first + 3 : contact.last - 2, contact.point]
        assert np.ptp(tip, axis=0).max() < (1e-4 if tolerance_m is None else 3e-3)
        flat = contact.place[2] - 0.36 * finished.body.actor.segments_m["foot.L"]
        assert tip[:, 2] == pytest.approx(flat, abs=1.5e-3)
    if tolerance_m is not None:
        keys = [len(curve(actor, final, f"hand.{side}").keyframe_points) for side in ("L", "R")]
        assert max(keys) < 0.3 * FRAMES


def test_a_motion_of_rigid_feet_is_finished_as_it_is(actor: bpy.types.Object) -> None:
    action = write_motion(actor, swaying(actor))
    bag = existing_channelbag(action, actor)
    for name in extremity_names(HUMAN):
        for each in [one for one in bag.fcurves if f'"{name}"' in one.data_path]:
            bag.fcurves.remove(each)
    _, final = final_action(actor, action, FinishOptions(None, False, None))
    paths = {one.data_path for one in existing_channelbag(final, actor).fcurves}
    assert not any("foot" in path or "hand" in path for path in paths)


def test_a_copied_hand_is_finished_as_it_was_keyed(actor: bpy.types.Object) -> None:
    keyframes = bpy.data.actions.new("Keyframes")
    actor.pose.bones["hand.L"].rotation_quaternion = (0.8, 0.6, 0.0, 0.0)
    store_pose(actor, keyframes, 7.0)
    action = write_motion(actor, swaying(actor), keyframe_action=keyframes)
    _, final = final_action(actor, action, FinishOptions(0.01, False, 0.03), keyframes)
    points = curve(actor, final, "hand.L").keyframe_points
    assert [(point.co.x, round(point.co.y, 5)) for point in points] == [(7.0, 0.6)]


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ", "AXIS_ANGLE"])
def test_a_hand_that_is_seen_is_put_right_where_it_is_posed(actor: bpy.types.Object, mode: str) -> None:
    bend = np.zeros((FRAMES, 2, 3))
    bend[:, 0, 2] = 0.4 * np.cos(np.arange(FRAMES) / 9.0)
    hands = Hands(np.full((FRAMES, 2, 5), 0.8), bend, np.full((FRAMES, 2), 0.9))
    motion = replace(swaying(actor), hands=hands)
    hand = actor.pose.bones["hand.L"]
    hand.rotation_mode = mode
    seen = tips(actor) if write_motion(actor, motion) else None
    action = bpy.data.actions.new("Keyframes")
    assign_action(actor, action)
    turns = {frame: Euler((0.0, 0.0, 0.0)) for frame in (1, 15, 22, 44)}
    turns |= {15: Euler((0.9, 0.0, 0.0)), 22: Euler((0.5, 0.0, -0.4))}
    posed = {}
    for frame, turn in turns.items():
        bpy.context.scene.frame_set(frame)
        for bone in actor.pose.bones:
            bone.matrix_basis = Matrix.Identity(4)
        hand.matrix_basis = turn.to_matrix().to_4x4()
        store_pose(actor, action, float(frame))
        bpy.context.view_layer.update()
        posed[frame] = np.array(hand.matrix_basis.to_quaternion())
    made = write_motion(actor, motion, keyframe_action=action)
    now = tips(actor)
    for frame, wanted in posed.items():
        bpy.context.scene.frame_set(frame)
        shown = np.array(hand.matrix_basis.to_quaternion())
        assert (abs(shown @ wanted) == pytest.approx(1.0, abs=1e-6)) == (frame in (15, 22))
    left = extremity_names(HUMAN).index("hand.L")
    moved = np.linalg.norm(now - seen, axis=-1)
    assert np.delete(moved, left, axis=1).max() < 1e-5
    assert moved[[0, 4, 32, 43], left].max() < 1e-5 and moved[10:25, left].min() > 5e-3
    _, final = final_action(actor, made, FinishOptions(0.01, False, None), action)
    assign_action(actor, final)
    assert np.linalg.norm(tips(actor) - now, axis=-1).max() < 0.011
