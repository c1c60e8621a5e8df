"""Postures on an armature and back: the border where core and Blender must agree."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.errors import InputError
from keymark.operators.bridge.armature import read_body
from keymark.operators.bridge.pose import read_posture, write_posture
from mathutils import Euler, Matrix, Quaternion, Vector

EXACT_M = 1e-5
MODES = ["QUATERNION", "AXIS_ANGLE", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"]
Points = Callable[[bpy.types.Object], np.ndarray]
RoundTrip = Callable[[bpy.types.Object, int], None]


@pytest.fixture
def check(random_posture: Callable[[int], Posture], shown_points: Points) -> RoundTrip:
    """Reading a written posture restores it, and Blender's bones match core's kinematics."""

    def round_trip(actor: bpy.types.Object, seed: int) -> None:
        body, posture = read_body(actor), random_posture(seed)
        write_posture(actor, posture)
        expected = body.points(body.pose(posture))
        assert shown_points(actor) == pytest.approx(expected, abs=EXACT_M)
        reading = read_posture(actor, body)
        assert body.points(body.pose(reading.posture)) == pytest.approx(expected, abs=EXACT_M)
        assert reading.posture.minus(posture) == pytest.approx(0.0, abs=5e-6)
        assert reading.furthest_m < EXACT_M

    return round_trip


@pytest.mark.parametrize("mode", [*MODES, "as built"])
@pytest.mark.parametrize("seed", range(4))
def test_round_trip_in_every_rotation_mode(
    actor: bpy.types.Object, check: RoundTrip, mode: str, seed: int
) -> None:
    if mode != "as built":
        for bone in actor.pose.bones:
            bone.rotation_mode = mode
    before = [bone.rotation_mode for bone in actor.pose.bones]
    check(actor, seed)
    assert [bone.rotation_mode for bone in actor.pose.bones] == before


def placed(scale: float) -> Matrix:
    return Matrix.LocRotScale(Vector((0.7, -1.2, 0.4)), Euler((0.3, -0.5, 2.1)), Vector((scale,) * 3))


@pytest.mark.parametrize("scale", [0.5, 1.0, 3.0])
def test_round_trip_for_an_object_anywhere_in_the_world(
    actor: bpy.types.Object, check: RoundTrip, scale: float
) -> None:
    actor.matrix_world = placed(scale)
    check(actor, 20)


def test_round_trip_for_an_object_that_hangs_on_another(actor: bpy.types.Object, check: RoundTrip) -> None:
    parent = bpy.data.objects.new("Stage", None)
    bpy.context.collection.objects.link(parent)
    actor.parent, parent.matrix_world = parent, placed(1.5)
    bpy.context.view_layer.update()
    check(actor, 30)


def test_round_trip_after_the_objects_transform_was_applied(
    actor: bpy.types.Object, check: RoundTrip
) -> None:
    actor.matrix_world = placed(1.2)
    bpy.context.view_layer.update()
    actor.select_set(True)
    bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
    assert actor.scale.x == pytest.approx(1.0)
    check(actor, 31)


def test_round_trip_after_the_rest_pose_became_an_a_pose(actor: bpy.types.Object, check: RoundTrip) -> None:
    for side in "LR":
        actor.pose.bones[f"upper_arm.{side}"].rotation_quaternion = Quaternion((0.0, 0.0, 1.0), -0.7)
    bpy.context.view_layer.objects.active = actor
    bpy.ops.object.mode_set(mode="POSE")
    bpy.ops.pose.armature_apply(selected=False)
    bpy.ops.object.mode_set(mode="OBJECT")
    check(actor, 32)


def test_hands_and_feet_keep_what_the_animator_gave_them(
    actor: bpy.types.Object, random_posture: Callable[[int], Posture]
) -> None:
    hand = actor.pose.bones["hand.L"]
    hand.rotation_quaternion = (0.8, 0.6, 0.0, 0.0)
    write_posture(actor, random_posture(40))
    assert tuple(hand.rotation_quaternion) == pytest.approx((0.8, 0.6, 0.0, 0.0))


def test_a_pose_beyond_the_freedoms_becomes_the_nearest_posture_and_says_so(
    actor: bpy.types.Object, body: Body
) -> None:
    forearm = actor.pose.bones["forearm.L"]
    forearm.rotation_euler = (0.6, 0.2, 0.3)  # bending, pronation, and a sideways turn the elbow cannot make
    reading = read_posture(actor, body)
    assert 0.2 * body.actor.segments_m["forearm.L"] < reading.furthest_m
    assert reading.furthest_m < 0.31 * body.actor.segments_m["forearm.L"]
    assert reading.furthest_m == pytest.approx(13 * reading.mean_m, abs=EXACT_M)  # the wrist alone is off


def test_a_bone_that_cannot_follow_does_not_turn_what_hangs_on_it(
    actor: bpy.types.Object, body: Body
) -> None:
    actor.pose.bones["girdle.L"].rotation_euler = (0.0, 0.0, 0.4)
    actor.pose.bones["upper_arm.L"].rotation_quaternion = Quaternion((0.0, 0.0, 1.0), -0.8)
    bpy.context.view_layer.update()
    shown = np.array(actor.pose.bones["upper_arm.L"].vector.normalized())
    reading = read_posture(actor, body)
    start, end = body.segment_ends(body.pose(reading.posture), "upper_arm.L")
    assert (end - start) / np.linalg.norm(end - start) == pytest.approx(shown, abs=1e-5)
    assert reading.furthest_m > 0.02


def test_an_evaluated_constraint_counts(actor: bpy.types.Object, body: Body, shown_points: Points) -> None:
    target = bpy.data.objects.new("Target", None)
    bpy.context.collection.objects.link(target)
    target.location = (0.25, -0.3, 0.3)
    shin = actor.pose.bones["shin.L"]
    constraint = shin.constraints.new("IK")
    constraint.target, constraint.chain_count = target, 2
    bpy.context.view_layer.update()
    reading = read_posture(actor, body)
    ankle = HUMAN.point_names.index("ankle.L")
    assert shown_points(actor)[ankle, 2] > 0.15  # the constraint has lifted it from 0.08
    read = body.points(body.pose(reading.posture))
    assert read[ankle] == pytest.approx(shown_points(actor)[ankle], abs=reading.furthest_m + EXACT_M)


def test_another_object_is_refused(body: Body) -> None:
    empty = bpy.data.objects.new("Nobody", None)
    with pytest.raises(InputError, match="'Nobody' is not an armature"):
        read_posture(empty, body)
