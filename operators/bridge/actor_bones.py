"""Telling Keymark's actors and their Actions from others, by the names of bones alone: quick enough to draw.

Nothing that starts slowly is imported, so that fields can ask while Blender starts.
"""

from collections.abc import Iterable

from bpy.types import Action, Armature, Bone, Object

from ...core.body.human import HUMAN, LIGHT, SHADED, side_of
from .actions import curves_of

ACTOR_BONES = tuple(segment.name for segment in HUMAN.segments)


def is_actor(candidate: Object | None) -> bool:
    """Whether an object is an armature with all the bones of Keymark's skeleton."""
    if candidate is None or candidate.type != "ARMATURE" or candidate.data is None:
        return False
    return not missing_bones(candidate)


def missing_bones(armature_object: Object) -> list[str]:
    """Bones of Keymark's skeleton that an armature lacks, in the skeleton's order."""
    return [name for name in ACTOR_BONES if name not in armature_object.data.bones]


def hips_at_rest(armature_object: Object) -> tuple[float, float, float]:
    """Where an actor's hips are at rest, in its own space; keys move them from there."""
    return tuple(armature_object.data.bones["pelvis"].head_local)


def moves_an_actor(action: Action) -> bool:
    """Whether an Action turns the bones of a Keymark actor."""
    # Every motion of an actor moves these bones; other rigs have hardly both.
    moved = [f'pose.bones["{bone}"].rotation_' for bone in ("pelvis", "girdle.L")]
    paths = [path for path, _ in curves_of(action)]
    return all(any(path.startswith(begin) for path in paths) for begin in moved)


EARLIER = {"L": "THEME01", "R": "THEME04", "": "THEME09"}  # palettes that actors of earlier versions have


def color_bones(bones: Iterable[Bone]) -> None:
    """Give bones the colors of their sides: the strong one, lighter where it is selected or active."""
    for bone in bones:
        side = side_of(bone.name)
        normal, light = ([level / 255.0 for level in colors[side]] for colors in (SHADED, LIGHT))
        bone.color.palette = "CUSTOM"
        custom = bone.color.custom
        custom.normal, custom.select = normal, light
        custom.active = [0.45 * level + 0.55 for level in light]  # whiter, to outshine the selected ones


def recolor_earlier(armature: Armature) -> None:
    """Give the bones of an actor of an earlier version their colors, except those colored by hand."""
    color_bones(bone for bone in armature.bones if bone.color.palette == EARLIER[side_of(bone.name)])
