"""How one performer differs from a library through a whole clip: what the first look teaches the second."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray

DEGREES = 4.0
"""Of Student's t, by which what is far off counts less."""
LEAST, MOST = 0.6, 6.0
"""Bounds of what deviations are multiplied by."""
BELIEVED = 4.0
"""The usual deviation counts for so many independent frames."""
ROUNDS = 12


@dataclass(frozen=True, eq=False)
class Habits:
    """Of M markers."""

    middle: Array
    """(M,) by what the usual deviation of the middle is to be multiplied: large for an arm that waves."""
    extent: Array
    """(M,) the same of the extent."""
    size: Array
    """(M,) how much larger the marker is than on an average body."""

    @classmethod
    def unknown(cls, markers: int) -> "Habits":
        """Of a performer of whom nothing is known yet."""
        return cls(np.ones(markers), np.ones(markers), np.ones(markers))


def scale(residual: Array, seen: BoolArray, tempering: float) -> Array:
    """(M,) by what deviations are to be multiplied to explain residuals, by Student's t.

    Args:
        residual: (T, M, K) in usual standard deviations.
        seen: (T, M) which of them count.
        tempering: What one frame counts for.
    """
    squared = (residual**2).sum(axis=-1)
    dimensions = residual.shape[-1]
    found = np.ones(residual.shape[1])
    frames = tempering * seen.sum(axis=0)
    for _ in range(ROUNDS):
        weight = (DEGREES + dimensions) / (DEGREES + squared / found**2)
        total = tempering * np.where(seen, weight * squared, 0.0).sum(axis=0) / dimensions
        found = np.sqrt((total + BELIEVED) / (frames + BELIEVED))
    return np.clip(found, LEAST, MOST)
