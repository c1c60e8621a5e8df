"""Baking the final Action: the evaluated motion of few keys, and the animator's own curves."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.progress import run
from keymark.core.take.motion import Motion
from keymark.operators.bridge.actions import assign_action, curves_of, existing_channelbag
from keymark.operators.bridge.armature import build_armature, read_body
from keymark.operators.bridge.fcurves import straighten_extremities, write_motion
from keymark.operators.bridge.keyframes import store_pose
from keymark.operators.bridge.rig import motion_frames, read_rig, read_values
from keymark.operators.shell.takes import add_take

FRAMES = 50
POSED = (1, 20, 35, 50)
ShownPoints = Callable[[bpy.types.Object], np.ndarray]


def motion_of(body: Body, posture: Posture) -> Motion:
    points = body.points(body.pose(posture))
    covariance = np.broadcast_to(1e-4 * np.eye(3), (FRAMES, 13, 3, 3))
    return Motion(body, 30.0, 1, np.arange(FRAMES) / 30.0, posture, points, covariance, (0,), "map")


@pytest.fixture
def take(
    registered: None, body: Body, wave_posture: Callable[[np.ndarray], Posture]
) -> bpy.types.PropertyGroup:
    """A take with a lively motion whose feet wander a little, and keyframes of it."""
    scene = bpy.context.scene
    scene.render.fps = 30
    scene.frame_end = FRAMES
    actor = build_armature(scene, body)
    actor.location, actor.scale = (0.4, -0.2, 0.1), (1.1, 1.1, 1.1)
    actor.pose.bones["upper_arm.L"].rotation_mode = "XYZ"
    actor.pose.bones["chest"].rotation_mode = "AXIS_ANGLE"
    bpy.context.view_layer.update()
    size = read_body(actor)
    time = np.linspace(0.0, 1.0, FRAMES)
    posture = wave_posture(0.5 - 0.5 * np.cos(4.0 * np.pi * time))
    noise = np.random.default_rng(2).normal(0.0, 0.002, (FRAMES, HUMAN.dof_count))
    posture = posture.plus(noise)
    result = add_take(scene, "Take")
    result.armature = actor
    result.motion_action = write_motion(actor, motion_of(size, posture))
    result.keyframe_action = bpy.data.actions.new("Keyframes")
    for frame in POSED:
        scene.frame_set(frame)
        straighten_extremities(actor, result.motion_action, None, frame)
        store_pose(actor, result.keyframe_action, frame)
    scene.frame_set(7)
    return result


def places(take: bpy.types.PropertyGroup, action: bpy.types.Action, shown_points: ShownPoints) -> np.ndarray:
    scene = bpy.context.scene
    assign_action(take.armature, action)
    before = scene.frame_current
    found = []
    for frame in range(1, FRAMES + 1):
        scene.frame_set(frame)
        found.append(shown_points(take.armature))
    scene.frame_set(before)
    return np.stack(found)


def curves(
    take: bpy.types.PropertyGroup, action: bpy.types.Action
) -> dict[tuple[str, int], bpy.types.FCurve]:
    return curves_of(action, take.armature)


@pytest.mark.parametrize("shared", ["PER_BONE", "WHOLE_POSE"])
def test_few_keys_show_the_motion_within_the_tolerance(
    take: bpy.types.PropertyGroup, shown_points: ShownPoints, shared: str
) -> None:
    settings = take.finish
    settings.plant_feet, settings.tolerance_mm, settings.shared = False, 6.0, shared
    assert bpy.ops.keymark.bake_motion() == {"FINISHED"}
    assert take.armature.animation_data.action == settings.action != take.motion_action
    distance = np.linalg.norm(
        places(take, settings.action, shown_points) - places(take, take.motion_action, shown_points), axis=-1
    )
    assert 1e3 * distance.max() <= 6.0
    assert 1e3 * distance.max() <= settings.furthest_mm + 0.05
    assert settings.keys_after < 0.5 * settings.keys_before
    assert bpy.context.scene.frame_current == 7


def test_keys_are_the_animators_own_and_posed_frames_stay(take: bpy.types.PropertyGroup) -> None:
    bpy.ops.keymark.bake_motion()
    for curve in curves(take, take.finish.action).values():
        points = curve.keyframe_points
        assert {point.type for point in points} == {"KEYFRAME"}
        assert {point.interpolation for point in points} == {"BEZIER"}
        assert set(POSED) <= {round(point.co.x, 3) for point in points}
        assert {point.handle_left_type for point in points} == {"ALIGNED"}
        assert not any(point.select_control_point for point in points)


def test_handles_give_the_cubic_that_was_checked(take: bpy.types.PropertyGroup) -> None:
    bpy.ops.keymark.bake_motion()
    curve = max(
        curves(take, take.finish.action).values(), key=lambda c: abs(c.range()[1] - len(c.keyframe_points))
    )
    first, second = curve.keyframe_points[0], curve.keyframe_points[1]
    length = second.co.x - first.co.x
    slopes = [
        (first.handle_right.y - first.co.y) / (first.handle_right.x - first.co.x),
        (second.co.y - second.handle_left.y) / (second.co.x - second.handle_left.x),
    ]
    for s in (0.25, 0.5, 0.8):
        rest = 1.0 - s
        cubic = rest**2 * ((1 + 2 * s) * first.co.y + s * length * slopes[0]) + s**2 * (
            (3 - 2 * s) * second.co.y - rest * length * slopes[1]
        )
        assert curve.evaluate(first.co.x + s * length) == pytest.approx(cubic, abs=2e-5)


def test_every_frame_keeps_everything(take: bpy.types.PropertyGroup, shown_points: ShownPoints) -> None:
    correction = curves(take, take.motion_action)['pose.bones["forearm.R"].rotation_euler', 0]
    correction.keyframe_points.insert(25.0, 2.0).type = "KEYFRAME"
    wanted = places(take, take.motion_action, shown_points)
    before = {key: len(c.keyframe_points) for key, c in curves(take, take.motion_action).items()}
    take.finish.keys, take.finish.plant_feet = "EVERY_FRAME", False
    bpy.ops.keymark.bake_motion()
    assert places(take, take.finish.action, shown_points) == pytest.approx(wanted, abs=1e-5)
    after = {key: len(c.keyframe_points) for key, c in curves(take, take.motion_action).items()}
    assert after == before
    keyed = curves(take, take.finish.action)['pose.bones["forearm.R"].rotation_euler', 0].keyframe_points
    assert len(keyed) == FRAMES
    assert keyed[24].co.y == pytest.approx(2.0)


def test_planted_feet_stand_still_in_blender(
    take: bpy.types.PropertyGroup, shown_points: ShownPoints, wave_posture: Callable[[np.ndarray], Posture]
) -> None:
    body = read_body(take.armature)
    time = np.arange(FRAMES) / 30.0
    sway = np.zeros((FRAMES, HUMAN.dof_count))
    sway[:, 0], sway[:, 1] = 0.012 * np.sin(4.0 * time), 0.01 * np.cos(3.0 * time)
    write_motion(
        take.armature, motion_of(body, wave_posture(np.full(FRAMES, 0.5)).plus(sway)), take.motion_action
    )
    ankles = [HUMAN.point_names.index(name) for name in ("ankle.L", "ankle.R")]
    loose = travel(places(take, take.motion_action, shown_points)[:, ankles])
    for keys in ("EVERY_FRAME", "TOLERANCE"):
        take.finish.keys = keys
        bpy.ops.keymark.bake_motion()
        assert take.finish.rests == 2
        held = travel(places(take, take.finish.action, shown_points)[:, ankles])
        assert (held < 0.2 * loose).all()


def travel(path: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.diff(path, axis=0), axis=-1).mean(axis=0)


def test_baking_again_writes_into_the_same_action(take: bpy.types.PropertyGroup) -> None:
    bpy.ops.keymark.bake_motion()
    action, count, actions = take.finish.action, take.finish.keys_after, len(bpy.data.actions)
    take.finish.tolerance_mm = 30.0
    bpy.ops.keymark.bake_motion()
    assert take.finish.action == action
    assert len(bpy.data.actions) == actions
    assert take.finish.keys_after < count
    assert (
        sum(len(curve.keyframe_points) for curve in curves(take, action).values()) == take.finish.keys_after
    )


def test_other_curves_come_along_and_what_judges_the_motion_stays_behind(
    take: bpy.types.PropertyGroup,
) -> None:
    channelbag = existing_channelbag(take.motion_action, take.armature)
    for curve in [curve for curve in channelbag.fcurves if '"hand.L"' in curve.data_path]:
        channelbag.fcurves.remove(curve)
    judged = '["Confidence (Keymark)"]'  # 0.1.0 kept it beside the motion
    for path in (judged, '["mood"]'):
        channelbag.fcurves.new(path, index=0).keyframe_points.insert(4.0, 0.5)
    assign_action(take.armature, take.motion_action)
    for frame in (3, 9):
        take.armature.pose.bones["hand.L"].keyframe_insert("rotation_quaternion", frame=frame)
    bpy.ops.keymark.bake_motion()
    final = curves(take, take.finish.action)
    points = final['pose.bones["hand.L"].rotation_quaternion', 0].keyframe_points
    assert [point.co.x for point in points] == [3.0, 9.0]
    assert ('["mood"]', 0) in final and (judged, 0) not in final


def test_the_rig_shows_what_blender_shows(take: bpy.types.PropertyGroup, shown_points: ShownPoints) -> None:
    armature_object, action = take.armature, take.motion_action
    body = read_body(armature_object)
    rig = read_rig(armature_object, body)
    frames = motion_frames(armature_object, action)
    assert list(frames[[0, -1]]) == [1.0, FRAMES]
    shown = rig.pose(run(read_values(armature_object, action, rig, frames))).points
    blender = places(take, action, shown_points)
    apart = np.linalg.norm(shown[:, None] - blender[:, :, None], axis=-1).min(axis=-1)
    assert apart.max() < 1e-5


def test_what_has_no_motion_is_refused_with_a_sentence(take: bpy.types.PropertyGroup) -> None:
    for action, sentence in (
        (None, "Reconstruct the motion first"),
        (bpy.data.actions.new("Empty"), "has no motion of 'Actor'"),
    ):
        take.motion_action = action
        with pytest.raises(RuntimeError, match=sentence):
            bpy.ops.keymark.bake_motion()
        assert take.finish.action is None
