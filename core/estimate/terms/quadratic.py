"""Terms that are quadratic in the unknowns, hence built once: smoothness, posed keyframes, biases."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..block_banded import REACH, BlockBanded
from ..clip_state import ClipState
from .term import NormalEquations

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class QuadraticTerm:
    """½ xᵀ M x over all unknowns."""

    matrix: BlockBanded

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add the term; annealing does not touch it."""
        equations.add_quadratic(self.matrix, state.unknowns)


class QuadraticBuilder:
    """Gathers independent rows, each a combination of one unknown over consecutive frames."""

    def __init__(self, frames: int, size: int) -> None:
        """No rows yet."""
        self.matrix = BlockBanded(frames, size)

    def add(self, columns: slice, coefficients: tuple[Array | float, ...], std: Array) -> None:
        """Add one row a frame and unknown: (Σ_k c_k x[t + k]) / std.

        Args:
            columns: The unknowns.
            coefficients: c_k for the K + 1 frames of a row, at most three, each a number or (R, 1) or (R, n).
            std: Standard deviation, broadcastable to (R, n), R = F - K; infinite switches a row off.
        """
        index = np.arange(self.matrix.size)[columns]
        rows = self.matrix.frames - len(coefficients) + 1
        if rows <= 0:
            return
        shape = (rows, len(index))
        information = np.broadcast_to(std, shape) ** -2.0
        parts = [np.broadcast_to(c, shape) for c in coefficients]
        for first, left in enumerate(parts):
            touched = slice(first, first + rows)
            self.matrix.diagonal[touched, index, index] += information * left**2
            if first + 1 < len(parts):
                self.matrix.next[touched, index, index] += information * left * parts[first + 1]
            if first + REACH < len(parts):
                self.matrix.after_next[touched, columns] += information * left * parts[first + REACH]

    def add_blocks(self, frames: NDArray[np.intp], information: Array) -> None:
        """Add full information matrices (K, n, n) about the leading n unknowns of K different frames."""
        count = information.shape[-1]
        self.matrix.diagonal[frames, :count, :count] += information

    def term(self) -> QuadraticTerm:
        """The term gathered so far."""
        return QuadraticTerm(self.matrix)
