"""Similarity transform of an armature object, and where an actor's joints are in the scene."""

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.errors import InputError
from ...core.retarget.character import Similarity


def object_space(armature_object: bpy.types.Object) -> Similarity:
    """The object's evaluated transform, parents and constraints included.

    Raises:
        InputError: The scale differs between axes or mirrors: limbs would change their lengths as they turn.
    """
    matrix = np.array(evaluated(armature_object).matrix_world, dtype=np.float64)
    linear = matrix[:3, :3]
    squared = linear.T @ linear
    scale = float(np.sqrt(np.trace(squared) / 3.0))
    uneven = np.abs(squared - scale**2 * np.eye(3)).max() > 1e-4 * scale**2
    if scale <= 0.0 or uneven or np.linalg.det(linear) < 0.0:
        scales = ", ".join(f"{value:.4g}" for value in np.sqrt(np.diag(squared)))
        raise InputError(
            f"armature '{armature_object.name}' is scaled by {scales} along its axes or mirrored; give "
            "it one positive scale, or apply the scale (Ctrl+A)"
        )
    return Similarity(linear / scale, matrix[:3, 3], scale)


def evaluated(blender_object: bpy.types.Object) -> bpy.types.Object:
    """The object as its scene evaluates it now; the object itself where no scene holds it.

    Of several scenes that hold it, each at a frame of its own, the context's scene counts.
    """
    scenes = blender_object.users_scene
    if not scenes:
        return blender_object
    scene = bpy.context.scene if bpy.context.scene in scenes else scenes[0]
    layer = bpy.context.view_layer if bpy.context.scene == scene else scene.view_layers[0]
    layer.update()
    return blender_object.evaluated_get(layer.depsgraph)


_ENDS = {
    "shoulder": ("upper_arm", "head"),
    "elbow": ("forearm", "head"),
    "wrist": ("forearm", "tail"),
    "hip": ("thigh", "head"),
    "knee": ("shin", "head"),
    "ankle": ("shin", "tail"),
    "head": ("head", "tail"),
}
"""The bone, and its end, that lies at each principal point."""


def joint_places(armature_object: bpy.types.Object) -> Array:
    """(13, 3) the principal points of an actor as its scene shows it now [m]."""
    shown = evaluated(armature_object)
    bones, matrix = shown.pose.bones, shown.matrix_world
    places = []
    for name in HUMAN.point_names:
        stem, dot, side = name.partition(".")
        bone, end = _ENDS[stem]
        places.append(matrix @ getattr(bones[f"{bone}{dot}{side}"], end))
    return np.array(places, dtype=np.float64)


def moved_by(scene: bpy.types.Scene, armature_object: bpy.types.Object) -> list[bpy.types.Object]:
    """What an armature moves in a scene: its children, and what it deforms."""
    deformed = [
        each
        for each in scene.objects
        if any(getattr(modifier, "object", None) == armature_object for modifier in each.modifiers)
    ]
    return list(dict.fromkeys([*armature_object.children_recursive, *deformed]))
