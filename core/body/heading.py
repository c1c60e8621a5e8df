"""Headings: rotations about the vertical, of single directions and of whole postures.

A heading is the turn about the world's Z from facing -Y.
"""

import numpy as np

from ..arrays import Array
from . import rotations
from .posture import Posture

UP = np.array([0.0, 0.0, 1.0])


def yaw_rotation(angle_rad: Array | float) -> Array:
    """(..., 3, 3) rotations about the vertical by angles (...)."""
    return rotations.hinge(UP, np.asarray(angle_rad))


def facing_rad(direction: Array) -> float:
    """Heading of a world direction (3,); 0 where it points straight up or down."""
    x, y = float(direction[0]), float(direction[1])
    return float(np.arctan2(x, -y)) if np.hypot(x, y) > 1e-9 else 0.0


def headings_rad(posture: Posture) -> Array:
    """(F,) headings of the pelvis; of the line through the hips where the pelvis faces up or down."""
    return turn_headings_rad(posture.rotations[..., 0, :, :])


def turn_headings_rad(turn: Array) -> Array:
    """(F,) headings of turns (F, 3, 3); of what was across where they make the front face up or down."""
    ahead = np.arctan2(-turn[..., 0, 1], turn[..., 1, 1])
    across = np.arctan2(turn[..., 1, 0], turn[..., 0, 0])
    level = np.hypot(turn[..., 0, 1], turn[..., 1, 1])
    return np.where(level > np.sqrt(0.5), ahead, across)


def yawed_at(posture: Posture, angle_rad: Array | float, hips: Array) -> Posture:
    """Postures turned about the vertical, with their hips at given points.

    Args:
        posture: A batch of N.
        angle_rad: (N,) or one angle.
        hips: (N, 3) the hips' midpoint [m].
    """
    matrices = np.array(posture.rotations)
    matrices[..., 0, :, :] = yaw_rotation(angle_rad) @ matrices[..., 0, :, :]
    return Posture(posture.skeleton, hips, matrices, posture.angles)


def yawed_in_place(posture: Posture, angle_rad: Array) -> Posture:
    """A single posture turned about the vertical through its hips by each of N angles: a batch of N."""
    batch = Posture.stack([posture] * len(angle_rad))
    return yawed_at(batch, angle_rad, batch.translation)


def turned_and_shifted(posture: Posture, angle_rad: Array | float, shift: Array) -> Posture:
    """Postures turned about the world's vertical axis, then shifted.

    Args:
        posture: A batch of F.
        angle_rad: (F,) or one angle.
        shift: (F, 3) or (3,) [m].
    """
    hips = (yaw_rotation(angle_rad) @ posture.translation[..., None])[..., 0] + shift
    return yawed_at(posture, angle_rad, hips)
