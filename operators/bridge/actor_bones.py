"""Telling Keymark's actors and their Actions from others, by the names of bones alone: quick enough to draw.

Nothing that starts slowly is imported, so that fields can ask while Blender starts.
"""

from collections.abc import Iterable

import bpy

from ...core.body.human import HUMAN, LIGHT, SHADED, side_of

ACTOR_BONES = frozenset(segment.name for segment in HUMAN.segments)
ROOT = "pelvis"
MOVED = (ROOT, "girdle.L")  # bones that every motion of an actor moves; other rigs have hardly both
TURNS = ("rotation_quaternion", "rotation_euler", "rotation_axis_angle")


def is_actor(candidate: bpy.types.Object | None) -> bool:
    """Whether an object is an armature with all the bones of Keymark's skeleton."""
    if candidate is None or candidate.type != "ARMATURE" or candidate.data is None:
        return False
    return ACTOR_BONES <= set(candidate.data.bones.keys())


def missing_bones(armature_object: bpy.types.Object) -> list[str]:
    """Bones of Keymark's skeleton that an armature lacks, in the skeleton's order."""
    there = armature_object.data.bones
    return [segment.name for segment in HUMAN.segments if segment.name not in there]


def hips_at_rest(armature_object: bpy.types.Object) -> tuple[float, float, float]:
    """Where an actor's hips are at rest, in its own space; keys move them from there."""
    return tuple(armature_object.data.bones[ROOT].head_local)


def moves_an_actor(action: bpy.types.Action) -> bool:
    """Whether an Action turns the bones of a Keymark actor."""
    bags = [bag for layer in action.layers for strip in layer.strips for bag in strip.channelbags]
    paths = [[f'pose.bones["{bone}"].{turn}' for turn in TURNS] for bone in MOVED]
    return any(all(any(map(bag.fcurves.find, turns)) for turns in paths) for bag in bags)


WHITER = 0.55  # share of white in the color of the active bone, which outshines the selected ones
EARLIER = {"L": "THEME01", "R": "THEME04", "": "THEME09"}
"""Palettes that actors of earlier versions have: red on the left and blue on the right."""


def color_bones(bones: Iterable[bpy.types.Bone]) -> None:
    """Give bones the colors of their sides: the strong one, lighter where it is selected or active."""
    for bone in bones:
        side = side_of(bone.name)
        normal, light = ([level / 255.0 for level in colors[side]] for colors in (SHADED, LIGHT))
        bone.color.palette = "CUSTOM"
        custom = bone.color.custom
        custom.normal, custom.select = normal, light
        custom.active = [level + WHITER * (1.0 - level) for level in light]


def recolor_earlier(armature: bpy.types.Armature) -> None:
    """Give the bones of an actor of an earlier version their colors, except those colored by hand."""
    color_bones(bone for bone in armature.bones if bone.color.palette == EARLIER[side_of(bone.name)])
