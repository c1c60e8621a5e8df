"""What holds a character's bones or carries its armature is let go of or reckoned with, or refused."""

from collections.abc import Callable
from dataclasses import replace

import bpy
import numpy as np
import pytest
from _armatures import build_character, retargeted
from _characters import plain_character, plain_map
from keymark.core.body.kinematics import SegmentMotion
from keymark.core.errors import InputError
from keymark.core.progress import run
from keymark.core.retarget.character import Character, CharacterBone
from keymark.core.retarget.maps.character_map import CharacterMap
from keymark.core.take.conversion_settings import Placement, RetargetOptions
from keymark.operators.bridge.character.retarget import retarget

FRAMES = 40
Made = tuple[bpy.types.Object, CharacterMap]


def in_ik(driver: str = "", path: str = 'pose.bones["root"]["legs"]') -> Made:
    """Legs that follow targets, knees with limits, feet that copy their target's turn."""
    plain = plain_character(root="root")
    goals = [
        CharacterBone(f"goal.{side}", 0, plain.bone(f"foot.{side}").rest, plain.bone(f"foot.{side}").tail)
        for side in "LR"
    ]
    made = build_character(Character("Game", (*plain.bones, *goals)))
    bones = made.pose.bones
    for owner in (bones["root"], made):
        owner["legs"] = 0.0 if driver.startswith("1 -") else 1.0
    for side in "LR":
        constraint = bones[f"shin.{side}"].constraints.new("IK")
        constraint.target, constraint.subtarget, constraint.chain_count = made, f"goal.{side}", 2
        limit = bones[f"shin.{side}"].constraints.new("LIMIT_ROTATION")
        limit.use_limit_y = limit.use_limit_z = True
        limit.owner_space = "LOCAL"
        turn = bones[f"foot.{side}"].constraints.new("COPY_ROTATION")
        turn.target, turn.subtarget = made, f"goal.{side}"
        for one in (constraint, limit, turn) if driver else ():
            curve = one.driver_add("influence")
            variable = curve.driver.variables.new()
            variable.name, variable.targets[0].id = "legs", made
            variable.targets[0].data_path = path
            curve.driver.expression = driver
    bpy.context.view_layer.update()
    return made, plain_map(plain)


def moving() -> bpy.types.Object:
    """An empty that turns and rises."""
    empty = bpy.data.objects.new("Cart", None)
    bpy.context.scene.collection.objects.link(empty)
    for frame, place in ((11, (1.0, 0.5, 0.3)), (50, (-2.0, 1.0, 1.5))):
        empty.location, empty.rotation_euler = place, (0.0, 0.1, frame / 20.0)
        empty.keyframe_insert("location", frame=frame)
        empty.keyframe_insert("rotation_euler", frame=frame)
    return empty


def on_cart() -> Made:
    """The armature hangs on what moves."""
    plain = plain_character()
    made = build_character(plain)
    made.parent = moving()
    bpy.context.view_layer.update()
    return made, plain_map(plain)


def on_bone() -> Made:
    """The armature hangs on another's bone, which moves."""
    made, known = on_cart()
    other = build_character(plain_character(names={}))
    other.parent, made.parent = made.parent, other
    made.parent_type, made.parent_bone = "BONE", "hand.L"
    bpy.context.view_layer.update()
    return made, known


def held_by(kind: str, bone: str) -> Made:
    """A bone that a constraint ties to what moves."""
    plain = plain_character(root="root")
    made = build_character(plain)
    made.pose.bones[bone].constraints.new(kind).target = moving()
    bpy.context.view_layer.update()
    return made, plain_map(plain)


@pytest.mark.parametrize(
    ("make", "note"),
    [
        (in_ik, "Constraints hold bone 'shin.L', 'foot.L', 'shin.R' and 1 more"),
        (lambda: in_ik("legs"), "Constraints hold bone 'shin.L'"),
        (lambda: in_ik("1 - legs"), "Constraints hold bone 'shin.L'"),
        (lambda: in_ik("1 - legs", '["legs"]'), "Constraints hold bone 'shin.L'"),
        (on_cart, "hangs on 'Cart', which moves: its place is keyed against it"),
        (on_bone, "which moves"),
        (lambda: held_by("CHILD_OF", "root"), "Constraints hold bone 'root'"),
        (lambda: held_by("COPY_TRANSFORMS", "hips"), "Constraints hold bone 'hips'"),
        (lambda: held_by("TRACK_TO", "head"), "Constraints hold bone 'head'"),
    ],
)
def test_the_performers_motion_is_seen(make: Callable[[], Made], note: str, source: SegmentMotion) -> None:
    made = make()
    influences = [[one.influence for one in bone.constraints] for bone in made[0].pose.bones]
    run(retarget(made[0], source, 11.0 + np.arange(FRAMES), made[1], RetargetOptions()))
    assert [[one.influence for one in bone.constraints] for bone in made[0].pose.bones] == influences
    done = retargeted(*made, source)
    assert [one for one in done.notes if note in one]
    quality = done.quality
    assert quality.legs_deg is not None and quality.legs_deg < 3.0
    assert quality.arms_deg is not None and quality.arms_deg < 3.0
    assert quality.skate_mm is not None and quality.skate_mm < 0.1
    assert quality.penetration_mm is not None and quality.penetration_mm < 2.0
    assert quality.lifted_mm is not None and quality.lifted_mm < 1.0
    assert not done.warnings
    hips = 0.5 * (source.start["thigh.L"] + source.start["thigh.R"])
    for index in (0, FRAMES - 1):
        bpy.context.scene.frame_set(11 + index)
        shown = made[0].evaluated_get(bpy.context.evaluated_depsgraph_get())
        place = np.array(shown.matrix_world @ shown.pose.bones["hips"].head)
        assert np.linalg.norm((place - hips[index])[:2]) < 0.1


def test_a_constraint_that_nothing_switches_off_is_refused(source: SegmentMotion) -> None:
    with pytest.raises(InputError, match=r"bone 'shin.L' of 'Game' is held by its constraint 'IK'.*legs are"):
        retargeted(*in_ik("1.0"), source)


def test_a_character_that_rides_is_measured_on_what_carries_it(source: SegmentMotion) -> None:
    done = retargeted(*on_cart(), source, replace(RetargetOptions(), place=Placement.CHARACTER))
    assert done.keys.placement == () and done.quality.skate_mm is not None and done.quality.skate_mm < 0.1
    assert [note for note in done.notes if "the motion rides on it" in note]


def test_a_parent_that_changes_its_size_is_refused(source: SegmentMotion) -> None:
    made = on_cart()
    made[0].parent.scale = (2.0,) * 3
    made[0].parent.keyframe_insert("scale", frame=50)
    made[0].parent.scale = (1.0,) * 3
    made[0].parent.keyframe_insert("scale", frame=11)
    with pytest.raises(InputError, match="hangs on 'Cart', whose scale changes"):
        retargeted(*made, source)
