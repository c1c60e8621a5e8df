"""The protocol of a term, what all of them cost, and the normal equations that terms add to."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..numerics.block_banded import BlockBanded
from ..numerics.robust import DEGREES, student_cost, student_weight
from .state import ClipState


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

    robust: ClassVar[bool]  # whether its noise has heavy tails; else the cost is half a sum of squares

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


# --- Rows whose errors last from frame to frame


@dataclass(frozen=True, eq=False)
class Drift:
    """Weights of N groups of G rows each in F frames."""

    level: Array  # (F, N) weight as errors too large, 0 to 1; 0 for what is not seen
    own: Array  # (F, N) information of the rows of a frame by themselves
    across: Array  # (F - 1, N) information that couples the rows of a frame to those of the next
    pull: Array  # (F, N, G) derivative of half the sum of squares by the errors


def drift(error: Array, used: BoolArray, kept: Array, temperature: float = 1.0) -> Drift:
    """The information that lasting errors have.

    `error` (F, N, G) over standard deviations; `used` (F, N): which are known; `kept` (F - 1, 1) or (F - 1,
    N): share φ of an error that is left in the next frame.
    """
    error = np.where(used[..., None], error, 0.0)
    size = error.shape[-1]
    level = np.where(used, student_weight((error**2).sum(-1) / temperature, DEGREES, size), 0.0)
    fresh = np.maximum(1.0 - kept**2, 1e-6) * temperature
    change = error[1:] - kept[..., None] * error[:-1]
    both = np.sqrt(level[1:] * level[:-1])
    steady = student_weight((change**2).sum(-1) / fresh, DEGREES, size)
    linked = both * steady / fresh
    # What follows an outlier, or is followed after a gap, begins anew.
    begun = level / temperature
    begun[1:] *= 1.0 - both
    own = begun.copy()
    own[1:] += linked
    own[:-1] += kept**2 * linked
    pull = begun[..., None] * error
    pull[1:] += linked[..., None] * change
    pull[:-1] -= (kept * linked)[..., None] * change
    return Drift(level, own, -kept * linked, pull)


def drift_cost(error: Array, used: BoolArray, kept: Array) -> Array:
    """(F,) negative logarithm of Student's t of errors that last, up to a constant; arguments as of `drift`.

    An error costs by its change, in so far as it and the one before are none too large, else by its size.
    """
    error = np.where(used[..., None], error, 0.0)
    size, squared = error.shape[-1], (error**2).sum(-1)
    level = np.where(used, student_weight(squared, DEGREES, size), 0.0)
    change = error[1:] - kept[..., None] * error[:-1]
    both = np.sqrt(level[1:] * level[:-1])
    cost = np.where(used, student_cost(squared, DEGREES, size), 0.0)
    fresh = np.maximum(1.0 - kept**2, 1e-6)
    cost[1:] += both * (student_cost((change**2).sum(-1) / fresh, DEGREES, size) - cost[1:])
    return np.asarray(cost.sum(-1))


def add_drift(equations: NormalEquations, jacobian: Array, rows: Drift, tangent_jacobian: Array) -> None:
    """Add rows with lasting errors.

    `jacobian` (F, N, G, D) of the errors, over their standard deviations, by the posture's tangent;
    `tangent_jacobian` (F, D, D) of that by the leading unknowns.
    """
    frames, points, size, dofs = jacobian.shape
    flat = jacobian.reshape(frames, points * size, dofs) @ tangent_jacobian
    own, across = (np.repeat(weight, size, axis=-1)[..., None] for weight in (rows.own, rows.across))
    turned = np.swapaxes(flat, -1, -2)
    equations.matrix.diagonal[:, :dofs, :dofs] += turned @ (own * flat)
    equations.matrix.next[:, :dofs, :dofs] += turned[:-1] @ (across * flat[1:])
    equations.gradient[:, :dofs] += (turned @ rows.pull.reshape(frames, -1, 1))[..., 0]


def add_errors(
    equations: NormalEquations,
    error: Array,
    used: BoolArray,
    jacobian: Array,
    kept: Array | None,
    temperature: float,
    tangent_jacobian: Array,
) -> None:
    """Add groups of rows (F, N, G), each an outlier as a whole: errors that last, or, `kept` None, do not."""
    if kept is not None:
        add_drift(equations, jacobian, drift(error, used, kept, temperature), tangent_jacobian)
        return
    error = np.where(used[..., None], error, 0.0)
    trust = student_weight((error**2).sum(-1) / temperature, DEGREES, error.shape[-1])
    weight = np.sqrt(np.where(used, trust, 0.0) / temperature)[..., None]
    jacobian = np.where(used[..., None, None], jacobian, 0.0) @ tangent_jacobian[:, None] * weight[..., None]
    frames, unknowns = len(error), jacobian.shape[-1]
    equations.add_rows((error * weight).reshape(frames, -1), jacobian.reshape(frames, -1, unknowns))


def errors_cost(error: Array, used: BoolArray, kept: Array | None) -> Array:
    """(F,) negative logarithm of Student's t, up to a constant; arguments as of `add_errors`."""
    if kept is not None:
        return drift_cost(error, used, kept)
    squared = np.where(used[..., None], error, 0.0) ** 2
    return np.asarray(student_cost(squared.sum(-1), DEGREES, error.shape[-1]).sum(-1))
