"""What a term of the whole-clip estimate is, and the equations it adds to."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..block_banded import BlockBanded
from ..clip_state import ClipState

Array = NDArray[np.float64]


class NormalEquations:
    """H step = -g, gathered from terms: H = Σ JᵀJ and g = Σ Jᵀr of whitened rows."""

    def __init__(self, frames: int, size: int) -> None:
        """Empty equations for `frames` frames of `size` unknowns."""
        self.matrix = BlockBanded(frames, size)
        self.gradient = np.zeros((frames, size))

    def add_rows(self, residual: Array, *jacobians: Array) -> None:
        """Add rows that touch one frame, or as many consecutive ones as there are Jacobians.

        Args:
            residual: (R, m) whitened residuals, row r touching frames r, r + 1, ...
            jacobians: One (R, m, n) array a touched frame, whitened alike.
        """
        self.matrix.add_rows(jacobians)
        for offset, jacobian in enumerate(jacobians):
            gradient = np.einsum("rmn,rm->rn", jacobian, residual)
            self.gradient[offset : offset + len(residual), : jacobian.shape[-1]] += gradient

    def add_quadratic(self, matrix: BlockBanded, unknowns: Array) -> None:
        """Add ½ xᵀ M x at the unknowns x (F, N)."""
        for mine, theirs in zip(self.matrix.bands, matrix.bands, strict=True):
            mine += theirs
        self.gradient += matrix.multiply(unknowns)


class Term(Protocol):
    """A term adds its linearised rows at a state; `temperature` ≥ 1 widens image noise while annealing."""

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add this term's rows."""
        ...


def student_weight(squared: Array, degrees: float, count: NDArray[np.intp] | int) -> Array:
    """Weight of rows under Student's t noise (Lange, Little & Taylor 1989), 1 at zero residual.

    Args:
        squared: Sum of squared whitened residuals of each group of rows.
        degrees: Degrees of freedom; fewer forgive more.
        count: Rows in each group.
    """
    return np.asarray(degrees / (degrees + squared / np.maximum(count, 1)))
