"""Similarity transform of an armature object, and where an actor's joints are in the scene."""

import bpy
import numpy as np
from bpy.types import Object, Scene

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.errors import InputError
from ...core.retarget.character import Similarity


def object_space(armature_object: Object) -> Similarity:
    """The object's evaluated transform; InputError if scaled unevenly: limbs would change as they turn."""
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
