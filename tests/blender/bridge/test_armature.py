"""The actor's armature: its bones, freedoms and sizes."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.errors import InputError
from keymark.operators.bridge.actor_bones import recolor_earlier
from keymark.operators.bridge.armature import read_body
from keymark.operators.overlays.drawing import SIDES


def test_the_actor_stands_on_the_floor_in_a_t_pose(actor: bpy.types.Object, body: Body) -> None:
    tails = np.array([bone.tail_local for bone in actor.data.bones])
    assert tails[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    hips = np.array(actor.data.bones["pelvis"].head_local)
    rest = body.points(body.pose(Posture.rest(HUMAN)))
    shoulder = rest[HUMAN.point_names.index("shoulder.L")]
    assert np.array(actor.data.bones["upper_arm.L"].head_local) - hips == pytest.approx(shoulder, abs=1e-6)
    assert actor.data.bones["forearm.L"].tail_local.x > actor.data.bones["forearm.L"].head_local.x > 0.0


def test_left_and_right_bones_mirror_each_other_as_blender_wants(actor: bpy.types.Object) -> None:
    for name in ("girdle", "upper_arm", "forearm", "hand", "thigh", "shin", "foot"):
        left, right = (np.array(actor.data.bones[f"{name}.{side}"].matrix_local)[:3, :3] for side in "LR")
        mirrored = np.diag([-1.0, 1.0, 1.0]) @ left @ np.diag([-1.0, 1.0, 1.0])
        assert right == pytest.approx(mirrored, abs=1e-6), name


def test_a_positive_turn_about_local_x_bends_the_joint(actor: bpy.types.Object) -> None:
    for name, outward in (
        *(("forearm.L", (0, -1, 0)), ("forearm.R", (0, -1, 0))),
        *(("shin.L", (0, 1, 0)), ("girdle.R", (0, 0, 1))),
    ):
        bone = actor.pose.bones[name]
        before = bone.tail.copy()
        bone.rotation_euler.x = 0.4
        bpy.context.view_layer.update()
        assert (bone.tail - before).dot(outward) > 0.03, name
        bone.rotation_euler.x = 0.0


def test_locks_mirror_the_degrees_of_freedom(actor: bpy.types.Object) -> None:
    locks = {bone.name: tuple(bone.lock_rotation) for bone in actor.pose.bones}
    assert locks["forearm.L"] == locks["shin.R"] == (False, False, True)
    assert locks["girdle.L"] == (False, True, True)
    assert locks["thigh.L"] == locks["chest"] == (False, False, False)
    moving = [bone.name for bone in actor.pose.bones if not all(bone.lock_location)]
    assert moving == ["pelvis"]


def test_limits_guide_inverse_kinematics_without_constraints(actor: bpy.types.Object) -> None:
    forearm = actor.pose.bones["forearm.R"]
    flexion = HUMAN.limits[HUMAN.dof_names.index("elbow.R.flexion")]
    assert forearm.use_ik_limit_x
    assert (forearm.ik_min_x, forearm.ik_max_x) == pytest.approx(tuple(flexion), abs=1e-6)
    assert not any(len(bone.constraints) for bone in actor.pose.bones)


def test_sides_have_collections_and_colors(actor: bpy.types.Object) -> None:
    members = {c.name: {bone.name for bone in c.bones} for c in actor.data.collections}
    assert members["Left"] == {bone.name for bone in actor.data.bones if bone.name.endswith(".L")}
    assert members["Middle"] == {"pelvis", "chest", "head"}
    for side, name in (("L", "hand.L"), ("R", "shin.R"), ("", "chest")):
        color = actor.data.bones[name].color
        assert color.palette == "CUSTOM"
        assert tuple(color.custom.select) == pytest.approx(SIDES[side][:3], abs=0.01)


def test_actors_of_earlier_versions_get_the_colors_of_today(actor: bpy.types.Object) -> None:
    colors = {name: actor.data.bones[name].color for name in ("hand.L", "hand.R", "foot.L")}
    for color, palette in zip(colors.values(), ("THEME01", "THEME04", "THEME06"), strict=True):
        color.palette = palette
    recolor_earlier(actor.data)
    for side in "LR":
        assert tuple(colors[f"hand.{side}"].custom.select) == pytest.approx(SIDES[side][:3], abs=0.01)
    assert colors["foot.L"].palette == "THEME06"


@pytest.mark.parametrize("scale", [1.0, 0.4, 2.5])
def test_the_sizes_are_read_back_with_the_objects_scale(
    actor: bpy.types.Object, body: Body, scale: float
) -> None:
    actor.scale = (scale, scale, scale)
    lengths = read_body(actor).actor.segments_m
    expected = {name: scale * length for name, length in body.actor.segments_m.items()}
    assert dict(lengths) == pytest.approx(expected, rel=1e-5)


def edited(actor: bpy.types.Object, change: Callable[[bpy.types.Armature], object]) -> None:
    bpy.context.view_layer.objects.active = actor
    bpy.ops.object.mode_set(mode="EDIT")
    change(actor.data)
    bpy.ops.object.mode_set(mode="OBJECT")


def lengthen(armature: bpy.types.Armature) -> None:
    forearm, hand = (armature.edit_bones[f"{part}.L"] for part in ("forearm", "hand"))
    shift = 0.03 * (forearm.tail - forearm.head).normalized()
    forearm.tail += shift
    hand.tail += shift


def displace(armature: bpy.types.Armature) -> None:
    upper_arm = armature.edit_bones["upper_arm.L"]
    upper_arm.use_connect = False
    upper_arm.head.z -= 0.15


def test_an_edited_length_is_read(actor: bpy.types.Object, body: Body) -> None:
    edited(actor, lengthen)
    lengths = read_body(actor).actor.segments_m
    expected = {**body.actor.segments_m, "forearm.L": body.actor.segments_m["forearm.L"] + 0.03}
    assert dict(lengths) == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda actor: setattr(actor, "scale", (1.0, 1.0, 1.3)), "scaled by 1, 1, 1.3.*apply the scale"),
        (lambda actor: setattr(actor, "scale", (-1.0, 1.0, 1.0)), "mirrored"),
        (lambda actor: setattr(actor.data.bones["shin.L"], "name", "calf"), r"lacks the bones shin\.L"),
        (lambda actor: edited(actor, displace), "mm off Keymark's skeleton"),
    ],
)
def test_what_is_no_actor_any_more_is_refused_with_what_to_do(
    actor: bpy.types.Object, spoil: Callable[[bpy.types.Object], None], sentence: str
) -> None:
    spoil(actor)
    with pytest.raises(InputError, match=sentence):
        read_body(actor)
