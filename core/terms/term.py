"""Terms: the state they are asked at, how rows are weighed and what they cost, and the normal equations.

A term gives rows: errors in standard deviations, their slopes, and which loss they have. Weighing outliers,
widening image noise while annealing, errors that last and the sum of the cost are written here, once for all.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body, Pose
from ..body.posture import Posture
from ..numerics.block_banded import BlockBanded
from ..numerics.robust import DEGREES, student_cost, student_weight


@dataclass(frozen=True, eq=False)
class ClipState:
    """Unknowns of a window or a frame, N = D + B in each of F frames.

    The first D unknowns z describe the deviation δ = L z from the prior, `posture = prior.plus(deviation)`;
    the factor L makes their accelerations independent and of unit size. The others are biases of image
    features.
    """

    body: Body
    prior: Posture  # a batch of F postures
    frame: IndexArray  # (F,) their indices in the clip, which a moving camera's pose depends on
    factor: Array  # (D, D) the matrix L [m, rad]
    variation: Array  # (F, D) the unknowns z
    bias: Array  # (F, B) [px]

    @property
    def frames(self) -> int:
        """Number of frames F."""
        return len(self.variation)

    @property
    def unknowns(self) -> Array:
        """(F, N) variation and bias side by side."""
        return np.concatenate([self.variation, self.bias], axis=1)

    @cached_property
    def deviation(self) -> Array:
        """(F, D) deviation δ from the prior [m, rad]."""
        return self.variation @ self.factor.T

    @cached_property
    def posture(self) -> Posture:
        """The batch of F estimated postures."""
        return self.prior.plus(self.deviation)

    @cached_property
    def pose(self) -> Pose:
        """Forward kinematics of the postures."""
        return self.body.pose(self.posture)

    @cached_property
    def tangent_jacobian(self) -> Array:
        """(F, D, D) Jacobian of the posture's own tangent by the unknowns z."""
        return np.asarray(self.prior.plus_jacobian(self.deviation) @ self.factor)

    def without_cache(self) -> "ClipState":
        """The same state without its cached properties, for which a long clip has no room."""
        return replace(self)

    def of_frames(self, frames: slice) -> "ClipState":
        """The state of some of its frames."""
        return replace(
            self,
            prior=self.prior[frames],
            frame=self.frame[frames],
            variation=self.variation[frames],
            bias=self.bias[frames],
        )

    def stepped(self, step: Array, largest: float) -> tuple["ClipState", float]:
        """The state a step (F, N) away, and the largest change of its postures.

        A frame's step is shortened so that no component of its deviation changes by more than `largest`.
        """
        count = self.variation.shape[1]
        moved = np.abs(step[:, :count] @ self.factor.T).max(axis=1)
        shrink = np.minimum(1.0, largest / np.maximum(moved, 1e-12))
        variation = self.variation + step[:, :count] * shrink[:, None]
        bias = self.bias + step[:, count:]
        return replace(self, variation=variation, bias=bias), float((moved * shrink).max())


class NormalEquations:
    """H step = -g, gathered from terms: H = Σ JᵀJ and g = Σ Jᵀr of whitened rows."""

    def __init__(self, frames: int, size: int) -> None:
        """Empty equations for `frames` frames of `size` unknowns."""
        self.matrix = BlockBanded(frames, size)
        self.gradient = np.zeros((frames, size))

    def add_rows(self, residual: Array, *jacobians: Array, first: int = 0) -> None:
        """Add rows that touch one frame or two consecutive ones.

        `residual` (R, m), row r touching frames `first` + r, `first` + r + 1, ...; one Jacobian (R, m, n) a
        touched frame, both whitened.
        """
        self.matrix.add_rows(jacobians, first)
        for start, jacobian in enumerate(jacobians, first):
            gradient = (residual[:, None] @ jacobian)[:, 0]
            self.gradient[start : start + len(residual), : jacobian.shape[-1]] += gradient

    def add_biases(
        self, residual: Array, jacobian: Array, weight: Array, bias: IndexArray, first: int
    ) -> None:
        """Add what rows that each have a bias of their own say of the biases.

        `residual` (R, m) with biases, of frames from `first` on; `jacobian` (R, m, n) by the leading
        unknowns, both whitened; `weight` (R, m): derivative of each row by its bias, the one `bias` (m,).
        """
        n, at = jacobian.shape[-1], slice(first, first + len(residual))
        block, bias = self.matrix.diagonal[at], n + bias
        mixed = jacobian * weight[..., None]
        block[:, bias, :n] += mixed
        block[:, :n, bias] += np.swapaxes(mixed, -1, -2)
        block[:, bias, bias] += weight**2
        self.gradient[at, bias] += weight * residual


FRAMES_AT_ONCE = 64  # whose rows are weighed and added together, so that they fit in the cache


@dataclass(frozen=True, eq=False)
class Rows:
    """N groups of G rows each in F frames. A group is an outlier as a whole."""

    error: Array  # (F, N, G) over standard deviations; any number where not used
    slopes: Array | None  # (F, N, G, D) of the errors by the posture's tangent; None where not asked for
    used: BoolArray  # (F, N) which groups are compared
    idle: Array | None = None  # (F, N) what groups cost that are not compared; None for nothing
    bias: tuple[Array, IndexArray] | None = None
    """Slopes (F, N, G) of the errors by biases of their own, and which of the biases (N, G) these are."""


class Term:
    """A kind of evidence or belief: `rows`, and in class attributes what their errors are like.

    What is no set of rows in single frames overrides `add_to` and `cost`.
    """

    degrees: ClassVar[float | None] = DEGREES  # of Student's t; None for a normal distribution
    is_image: ClassVar[bool] = False  # whether annealing widens its noise
    counts: ClassVar[float] = 1.0  # what each row counts, where more of them err together
    lasting: Array | None = None
    """(F - 1, 1) share of an error that is left in the next frame; None where frames err apart."""

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """The rows at a state; with `slopes`, which a cost does not need."""
        raise NotImplementedError

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add this term's weighed rows; `temperature` ≥ 1 widens image noise while annealing."""
        temperature = temperature if self.is_image else 1.0
        for rows in self.rows(state):
            error = np.where(rows.used[..., None], rows.error, 0.0)
            frames, groups, size = error.shape
            assert rows.slopes is not None
            slopes = rows.slopes.reshape(frames, groups * size, rows.slopes.shape[-1])
            used = np.repeat(rows.used, size, axis=-1)[..., None]
            level = self._levels(error, rows.used, temperature)
            if self.lasting is not None:
                jacobian = np.where(used, slopes, 0.0) @ state.tangent_jacobian
                _add_lasting(equations, error, level, jacobian, self.lasting, temperature)
                continue
            weight = np.repeat(np.sqrt(level * (self.counts / temperature)), size, axis=-1)
            residual = error.reshape(frames, -1) * weight
            for first in range(0, frames, FRAMES_AT_ONCE):
                at = slice(first, first + FRAMES_AT_ONCE)
                whitened = np.where(used[at], slopes[at] * weight[at, :, None], 0.0)
                jacobian = whitened @ state.tangent_jacobian[at]
                equations.add_rows(residual[at], jacobian, first=first)
                if rows.bias is not None:
                    by_bias, index = rows.bias
                    own = by_bias[at].reshape(len(jacobian), -1) * weight[at]
                    equations.add_biases(residual[at], jacobian, own, index.ravel(), first)

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of each frame's probability, up to a constant."""
        total = np.zeros(state.frames)
        for rows in self.rows(state, slopes=False):
            error = np.where(rows.used[..., None], rows.error, 0.0)
            cost = self._loss((error**2).sum(-1), error.shape[-1])
            if self.lasting is not None and len(error) > 1:
                # An error costs by its change, in so far as it and the one before are none too large.
                levels = self._levels(error, rows.used, 1.0)
                both = np.sqrt(levels[1:] * levels[:-1])
                change = error[1:] - self.lasting[..., None] * error[:-1]
                squared = (change**2).sum(-1) / np.maximum(1.0 - self.lasting**2, LEAST_FRESH)
                cost[1:] += both * (self._loss(squared, error.shape[-1]) - cost[1:])
            if rows.idle is not None:
                cost = np.where(rows.used, cost, rows.idle)
            total += self.counts * cost.sum(-1)
        return total

    def _levels(self, error: Array, used: BoolArray, temperature: float) -> Array:
        """(F, N) weights of groups by the size of their errors, 0 to 1; 0 for what is not compared."""
        if self.degrees is None:
            return used.astype(np.float64)
        squared = (error**2).sum(-1) / temperature
        return np.where(used, student_weight(squared, self.degrees, error.shape[-1]), 0.0)

    def _loss(self, squared: Array, size: int) -> Array:
        return 0.5 * squared if self.degrees is None else student_cost(squared, self.degrees, size)


LEAST_FRESH = 1e-6  # least variance of what is new in a lasting error, as a share


def _add_lasting(
    equations: NormalEquations, error: Array, level: Array, jacobian: Array, kept: Array, temperature: float
) -> None:
    """Add groups of rows whose errors last from frame to frame (quasi-differences, Cochrane & Orcutt 1949).

    `error` (F, N, G), 0 where not compared; `level` (F, N) as of `Term._levels`; `jacobian` (F, N G, D);
    `kept` (F - 1, 1) or (F - 1, N): share φ of an error that is left in the next frame.
    """
    size, dofs = error.shape[-1], jacobian.shape[-1]
    fresh = np.maximum(1.0 - kept**2, LEAST_FRESH) * temperature
    change = error[1:] - kept[..., None] * error[:-1]
    both = np.sqrt(level[1:] * level[:-1])
    linked = both * student_weight((change**2).sum(-1) / fresh, DEGREES, size) / fresh
    # What follows an outlier, or is followed after a gap, begins anew.
    begun = level / temperature
    begun[1:] *= 1.0 - both
    own = begun.copy()
    own[1:] += linked
    own[:-1] += kept**2 * linked
    pull = begun[..., None] * error
    pull[1:] += linked[..., None] * change
    pull[:-1] -= (kept * linked)[..., None] * change
    weight, across = (np.repeat(one, size, axis=-1)[..., None] for one in (own, -kept * linked))
    turned = np.swapaxes(jacobian, -1, -2)
    equations.matrix.diagonal[:, :dofs, :dofs] += turned @ (weight * jacobian)
    equations.matrix.next[:, :dofs, :dofs] += turned[:-1] @ (across * jacobian[1:])
    equations.gradient[:, :dofs] += (turned @ pull.reshape(len(error), -1, 1))[..., 0]


def total_cost(terms: Iterable[Term], state: ClipState) -> Array:
    """(F,) negative logarithm of the probability of each frame's state, up to a constant."""
    return np.sum([term.cost(state) for term in terms], axis=0)


@dataclass(frozen=True, eq=False)
class QuadraticTerm(Term):
    """½ xᵀ M x over all unknowns x; annealing does not touch it."""

    matrix: BlockBanded

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add the term."""
        equations.matrix.add(self.matrix)
        equations.gradient += self.matrix.multiply(state.unknowns)

    def cost(self, state: ClipState) -> Array:
        """(F,) each frame's share of ½ xᵀ M x."""
        return np.asarray(0.5 * (state.unknowns * self.matrix.multiply(state.unknowns)).sum(-1))
