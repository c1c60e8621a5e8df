"""Terms that are quadratic in the unknowns, hence built once: posed keyframes, biases, weak priors."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array, IndexArray
from ..block_banded import BlockBanded
from ..clip_state import ClipState
from .term import NormalEquations


@dataclass(frozen=True, eq=False)
class QuadraticTerm:
    """½ xᵀ M x over all unknowns."""

    matrix: BlockBanded
    robust: ClassVar[bool] = False

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add the term; annealing does not touch it."""
        equations.add_quadratic(self.matrix, state.unknowns)

    def cost(self, state: ClipState) -> Array:
        """(F,) each frame's share of ½ xᵀ M x."""
        unknowns = state.unknowns
        return np.asarray(0.5 * (unknowns * self.matrix.multiply(unknowns)).sum(-1))


class QuadraticBuilder:
    """Gathers independent rows, each a combination of one unknown over consecutive frames."""

    def __init__(self, frames: int, size: int) -> None:
        """No rows yet."""
        self.matrix = BlockBanded(frames, size)

    def add(self, columns: slice, coefficients: tuple[Array | float, ...], std: Array | float) -> None:
        """Add one row a frame and unknown, as `BlockBanded.add_combination` does.

        Args:
            columns: The unknowns.
            coefficients: Of the consecutive frames.
            std: Standard deviation; infinite switches a row off.
        """
        self.matrix.add_combination(columns, coefficients, np.asarray(std, dtype=np.float64) ** -2.0)

    def add_blocks(self, frames: IndexArray, information: Array) -> None:
        """Add full information matrices (K, n, n) about the leading n unknowns of K different frames."""
        count = information.shape[-1]
        self.matrix.diagonal[frames, :count, :count] += information

    def term(self) -> QuadraticTerm:
        """The term gathered so far."""
        return QuadraticTerm(self.matrix)
