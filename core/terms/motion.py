"""The motion departs smoothly from the prior, with bursts: heavy-tailed second differences, limb by limb.

A kick or a sudden stop is an acceleration far beyond the usual in one limb for a few frames. Student's t
distribution allows for it without loosening the rest of the clip (Lange, Little & Taylor 1989).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..numerics.block_banded import BlockBanded
from ..numerics.robust import DEGREES, student_cost, student_weight
from .term import ClipState, NormalEquations, QuadraticTerm, Rows, Term

SECOND_DIFFERENCE = (1.0, -2.0, 1.0)


@dataclass(frozen=True, eq=False)
class SmoothnessTerm(Term):
    """Second differences of the unknowns z, whose usual size is one at 30 frames a second."""

    std: float  # usual size at the clip's own pace

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add a row for each unknown and inner frame."""
        second, squared = self._differences(state)
        information = np.empty_like(second)
        for limb, size in zip(state.prior.skeleton.limbs, squared, strict=True):
            information[:, limb] = student_weight(size, DEGREES, 1)[:, None]
        information /= self.std**2
        columns = slice(0, second.shape[1])
        equations.matrix.add_combination(columns, SECOND_DIFFERENCE, information)
        pull = information * second * self.std
        for offset, coefficient in enumerate(SECOND_DIFFERENCE):
            equations.gradient[offset : offset + len(pull), columns] += coefficient * pull

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of Student's t over all limbs, up to a constant; by the middle frame."""
        cost = np.zeros(state.frames)
        for squared in self._differences(state)[1]:
            cost[1 : 1 + len(squared)] += student_cost(squared, DEGREES, 1)
        return cost

    def _differences(self, state: ClipState) -> tuple[Array, list[Array]]:
        """(F - 2, D) in usual sizes, and of each limb, whose components are weighed together, the square."""
        second = np.diff(state.variation, n=2, axis=0) / self.std
        return second, [(second[:, limb] ** 2).sum(axis=1) for limb in state.prior.skeleton.limbs]


def belief_term(frames: int, dof_count: int, bias_std: Array) -> QuadraticTerm:
    """Normal distributions of the unknowns z, of unit size, and of the biases (1, B) [px], frame by frame."""
    matrix = BlockBanded(frames, dof_count + bias_std.shape[1])
    matrix.add_combination(slice(0, dof_count), (1.0,), np.ones(dof_count))
    matrix.add_combination(slice(dof_count, None), (1.0,), bias_std**-2.0)
    return QuadraticTerm(matrix)


LIMIT_STD_RAD = 0.03  # how far hinges go past their range


@dataclass(frozen=True)
class LimitTerm(Term):
    """A one-sided spring on every hinge past its range."""

    degrees: ClassVar[float | None] = None

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """A row for each hinge, zero within its range."""
        skeleton = state.prior.skeleton
        hinges = skeleton.hinge_dofs
        lower, upper = skeleton.limits[hinges].T
        angles = state.posture.angles
        past = angles - np.clip(angles, lower, upper)
        by = np.eye(skeleton.dof_count)[hinges, None] / LIMIT_STD_RAD
        by = np.broadcast_to(by, (state.frames, *by.shape))
        yield Rows(past[..., None] / LIMIT_STD_RAD, by if slopes else None, past != 0.0)
