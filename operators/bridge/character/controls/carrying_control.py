"""The control that carries something: a whole body, or what a limb's inverse kinematics reaches for."""

from collections.abc import Sequence

import bpy
import numpy as np

from .....core.retarget.controls.rigid_offset import rigid_offset
from .dependencies import Graph, upstream
from .posing import posing, read_poses, set_channels

TRIED = ((0.3, -0.2, 0.25), (-0.2, 0.3, -0.1))
"""Locations that a control is given, in tenths of the character's size."""
SAME = 1e-3
"""Largest difference from moving along, in sizes of the character."""


def carrying_control(
    armature_object: bpy.types.Object,
    graph: Graph,
    candidates: Sequence[str],
    carried: Sequence[str],
    size: float,
) -> str | None:
    """The nearest control that carries all of some bones as if they were one with it; None where none does.

    Args:
        armature_object: The character.
        graph: Its dependencies.
        candidates: Bones that a person may pose.
        carried: The bones.
        size: The character's, in the armature's units.
    """
    if not carried:
        return None
    above = set.intersection(*(upstream(graph, [name]) for name in carried)) & set(candidates)
    # The nearest is the one that depends on the most of the others.
    nearest = sorted(above, key=lambda name: (-len(upstream(graph, [name]) & above), name))
    with posing(armature_object):
        return next(
            (name for name in nearest if _carries(armature_object, name, carried, size)),
            None,
        )


def _carries(armature_object: bpy.types.Object, name: str, carried: Sequence[str], size: float) -> bool:
    """Whether bones move with a control as if they were one with it."""
    channels = armature_object.pose.bones[name].matrix_basis.copy()
    poses = []
    for turn in (None, *TRIED):
        matrix = np.eye(4)
        if turn is not None:
            matrix[:3, 3] = 0.1 * size * np.array(turn)
            matrix[:3, :3] = [[0.96, -0.28, 0.0], [0.28, 0.96, 0.0], [0.0, 0.0, 1.0]]
        set_channels(armature_object, {name: matrix})
        poses.append(read_poses(armature_object, [name, *carried])[1])
    armature_object.pose.bones[name].matrix_basis = channels
    every = np.array(poses)
    return all(
        max(rigid_offset(every[:, 0], every[:, index + 1])[1:]) < SAME * max(size, 1.0)
        for index in range(len(carried))
    )
