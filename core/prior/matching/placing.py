"""Postures turned about the vertical and put in their places."""

import numpy as np
from numpy.typing import NDArray

from ...body.posture import Posture
from ...body.rotations import exponential

Array = NDArray[np.float64]


def about_up(angle_rad: Array) -> Array:
    """(..., 3, 3) rotations about the vertical."""
    return exponential(np.asarray(angle_rad)[..., None] * np.array([0.0, 0.0, 1.0]))


def placed(posture: Posture, heading_rad: Array, hips: Array) -> Posture:
    """Postures (N,) turned about the vertical by angles (N,) and put with their hips to places (N, 3) [m]."""
    rotations = np.array(posture.rotations)
    rotations[:, 0] = about_up(heading_rad) @ rotations[:, 0]
    return Posture(posture.skeleton, hips, rotations, posture.angles)
