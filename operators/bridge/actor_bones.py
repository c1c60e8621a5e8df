"""Telling Keymark's actors and their Actions from others, by the names of bones alone: quick enough to draw.

Nothing that starts slowly is imported, so that fields can ask while Blender starts.
"""

from collections.abc import Iterable

import bpy
import numpy as np
from bpy.types import Action, Armature, Bone, Object, Scene

from ...core.arrays import Array
from ...core.body.human import HUMAN, LIGHT, SHADED, side_of
from ...core.errors import InputError
from ...core.retarget.character import Similarity
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


def object_space(armature_object: Object) -> Similarity:
    """The object's evaluated transform; InputError if scaled unevenly: limbs would change as they turn."""
    matrix = np.array(evaluated(armature_object).matrix_world, dtype=np.float64)
    linear = matrix[:3, :3]
    squared = linear.T @ linear
    scale = float(np.sqrt(np.trace(squared) / 3.0))
    uneven = np.abs(squared - scale**2 * np.eye(3)).max() > 1e-4 * scale**2
    if scale <= 0.0 or uneven or np.linalg.det(linear) < 0.0:
        scales = ", ".join(f"{value:.4g}" for value in np.sqrt(np.diag(squared)))
        how = (
            f"scaled by {scales} along its axes"
            if uneven
            else "mirrored by a negative scale, maybe a parent's"
        )
        raise InputError(
            f"armature '{armature_object.name}' is {how}; give it one positive scale, or apply the scale "
            "(Ctrl+A)"
        )
    return Similarity(linear / scale, matrix[:3, 3], scale)


def evaluated(blender_object: Object) -> Object:
    """The object as its scene evaluates it now, the context's scene before others; itself in no scene."""
    scenes = blender_object.users_scene
    if not scenes:
        return blender_object
    scene = bpy.context.scene if bpy.context.scene in scenes else scenes[0]
    layer = bpy.context.view_layer if bpy.context.scene == scene else scene.view_layers[0]
    layer.update()
    return blender_object.evaluated_get(layer.depsgraph)


ENDS = {
    **{"shoulder": ("upper_arm", "head"), "elbow": ("forearm", "head"), "wrist": ("forearm", "tail")},
    **{"hip": ("thigh", "head"), "knee": ("shin", "head"), "ankle": ("shin", "tail")},
    "head": ("head", "tail"),
}
"""The bone, and its end, that lies at each principal point."""


def joint_places(armature_object: Object) -> Array:
    """(13, 3) the principal points of an actor as its scene shows it now [m]."""
    shown, places = evaluated(armature_object), []
    for name in HUMAN.point_names:
        stem, dot, side = name.partition(".")
        bone, end = ENDS[stem]
        places.append(shown.matrix_world @ getattr(shown.pose.bones[f"{bone}{dot}{side}"], end))
    return np.array(places, dtype=np.float64)


def moved_by(scene: Scene, armature_object: Object) -> list[Object]:
    """What an armature moves in a scene: its children, and what it deforms."""
    deformed = [
        each
        for each in scene.objects
        if any(getattr(modifier, "object", None) == armature_object for modifier in each.modifiers)
    ]
    return list(dict.fromkeys([*armature_object.children_recursive, *deformed]))
