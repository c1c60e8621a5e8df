"""Where the joints of an actor are in the scene, read from its bones alone: quick enough to draw."""

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.human import HUMAN
from .object_space import evaluated

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
