"""Which of several controls a bone follows rigidly."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from .control_spaces import unscaled

RIGID_RAD = 2e-3
"""Largest turn of a bone against a control that it follows [rad]."""
RIGID = 1e-3
"""Largest distance, in sizes of the character."""


def followed_controls(
    controls: Sequence[str], control_poses: Array, bone_poses: Array, size: float
) -> list[str | None]:
    """For each bone the control that it follows in place and turn, else in turn alone; None where none is.

    A bone that is bound to its parent's tail stays there whatever its constraints say, and a limb in inverse
    kinematics may not get to its goal; both are turned all the same.

    Args:
        controls: Names of the C controls, each posed on its own.
        control_poses: (S, C, 4, 4).
        bone_poses: (S, B, 4, 4).
        size: The character's, in the poses' units.
    """
    if not controls:
        return [None] * bone_poses.shape[1]
    axes = np.swapaxes(unscaled(control_poses[..., :3, :3]), -1, -2)[:, :, None]  # (S, C, 1, 3, 3)
    turns = axes @ unscaled(bone_poses[..., :3, :3])[:, None]  # (S, C, B, 3, 3)
    apart = bone_poses[:, None, :, :3, 3] - control_poses[:, :, None, :3, 3]
    places = (axes @ apart[..., None])[..., 0]
    turned = _spread(turns, (-2, -1)) / np.sqrt(2.0)  # near enough the angle, where it is small
    moved = _spread(places, (-1,))
    whole = np.maximum(turned / RIGID_RAD, moved / (RIGID * size))  # (C, B)
    return [
        next((controls[int(off.argmin())] for off in (each, by_turn) if off.min() < 1.0), None)
        for each, by_turn in zip(whole.T, turned.T / RIGID_RAD, strict=True)
    ]


def _spread(values: Array, axis: tuple[int, ...]) -> Array:
    """Largest distance from the mean over the samples, which lead."""
    return np.asarray(np.sqrt(((values - values.mean(axis=0)) ** 2).sum(axis=axis)).max(axis=0))
