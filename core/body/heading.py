"""Turning about the vertical."""

import numpy as np

from ..arrays import Array
from . import rotations
from .posture import Posture

UP = np.array([0.0, 0.0, 1.0])


def yaw_rotation(angle_rad: Array | float) -> Array:
    """(..., 3, 3) rotations about the vertical by angles (...)."""
    return rotations.hinge(UP, np.asarray(angle_rad))


def yawed_at(posture: Posture, angle_rad: Array | float, place: Array) -> Posture:
    """Postures turned about the vertical, their hips in given places.

    Args:
        posture: A batch of N.
        angle_rad: (N,) or one angle.
        place: (N, 3) of the hips' midpoint [m].
    """
    matrices = np.array(posture.rotations)
    matrices[..., 0, :, :] = yaw_rotation(angle_rad) @ matrices[..., 0, :, :]
    return Posture(posture.skeleton, place, matrices, posture.angles)
