"""The protocol of a term, what all of them cost, and the normal equations that terms add to."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from ...arrays import Array, IndexArray
from ..block_banded import BlockBanded
from ..clip_state import ClipState


class NormalEquations:
    """H step = -g, gathered from terms: H = Σ JᵀJ and g = Σ Jᵀr of whitened rows."""

    def __init__(self, frames: int, size: int) -> None:
        """Empty equations for `frames` frames of `size` unknowns."""
        self.matrix = BlockBanded(frames, size)
        self.gradient = np.zeros((frames, size))

    def add_rows(self, residual: Array, *jacobians: Array) -> None:
        """Add rows that touch one frame or two consecutive ones.

        `residual` (R, m), row r touching frames r, r + 1, ...; one Jacobian (R, m, n) a touched frame, both
        whitened.
        """
        self.matrix.add_rows(jacobians)
        for offset, jacobian in enumerate(jacobians):
            gradient = (residual[:, None] @ jacobian)[:, 0]
            self.gradient[offset : offset + len(residual), : jacobian.shape[-1]] += gradient

    def add_biased_rows(self, residual: Array, jacobian: Array, bias_weight: Array) -> None:
        """Add rows that each have a bias of their own; the biases are the last unknowns of a frame.

        `residual` (F, m) with biases, `jacobian` (F, m, n) by the leading unknowns, both whitened;
        `bias_weight` (F, m): derivative of each row by its bias.
        """
        self.add_rows(residual, jacobian)
        n, block = jacobian.shape[-1], self.matrix.diagonal
        mixed = jacobian * bias_weight[..., None]
        block[:, n:, :n] += mixed
        block[:, :n, n:] += np.swapaxes(mixed, -1, -2)
        bias = np.arange(n, block.shape[-1])
        block[:, bias, bias] += bias_weight**2
        self.gradient[:, n:] += bias_weight * residual

    def add_quadratic(self, matrix: BlockBanded, unknowns: Array) -> None:
        """Add ½ xᵀ M x at the unknowns x (F, N)."""
        self.matrix.add(matrix)
        self.gradient += matrix.multiply(unknowns)


class Term(Protocol):
    """A term adds its linearized rows at a state, and tells its cost, by which states are chosen between."""

    robust: ClassVar[bool]
    """Whether its noise has heavy tails; without them the cost is half a sum of squares."""

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add this term's rows; `temperature` ≥ 1 widens image noise while annealing."""
        ...

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of each frame's probability, up to a constant."""
        ...


def total_cost(terms: Iterable[Term], state: ClipState) -> Array:
    """(F,) negative logarithm of the probability of each frame's state, up to a constant.

    Sums of squares are added before robust costs: the order is fixed because rounding depends on it.
    """
    total = np.zeros(state.frames)
    for term in sorted(terms, key=lambda term: term.robust):
        total = total + term.cost(state)
    return total


# --- Terms that are quadratic in the unknowns, hence built once


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

        An infinite `std` switches a row off.
        """
        self.matrix.add_combination(columns, coefficients, np.asarray(std, dtype=np.float64) ** -2.0)

    def add_blocks(self, frames: IndexArray, information: Array) -> None:
        """Add full information matrices (K, n, n) about the leading n unknowns of K different frames."""
        count = information.shape[-1]
        self.matrix.diagonal[frames, :count, :count] += information

    def term(self) -> QuadraticTerm:
        """The term gathered so far."""
        return QuadraticTerm(self.matrix)
