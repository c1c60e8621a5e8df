"""The motion departs smoothly from the prior, with bursts: heavy-tailed second differences, limb by limb.

A kick or a sudden stop is an acceleration far beyond the usual in one limb for a few frames. Student's t
distribution allows for it without loosening the rest of the clip (Lange, Little & Taylor 1989).
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..numerics.robust import DEGREES, student_cost, student_weight
from .state import ClipState
from .term import NormalEquations, QuadraticBuilder, QuadraticTerm

SECOND_DIFFERENCE = (1.0, -2.0, 1.0)


@dataclass(frozen=True, eq=False)
class SmoothnessTerm:
    """Second differences of the unknowns z, whose usual size is one at 30 frames a second."""

    std: float  # usual size at the clip's own pace
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add a row for each unknown and inner frame."""
        if state.frames < 3:
            return
        second = np.diff(state.variation, n=2, axis=0) / self.std
        information = np.empty_like(second)
        for limb in state.prior.skeleton.limbs:
            squared = (second[:, limb] ** 2).sum(axis=1, keepdims=True)
            information[:, limb] = student_weight(squared, DEGREES, 1)
        information /= self.std**2
        columns = slice(0, second.shape[1])
        equations.matrix.add_combination(columns, SECOND_DIFFERENCE, information)
        pull = information * second * self.std
        for offset, coefficient in enumerate(SECOND_DIFFERENCE):
            equations.gradient[offset : offset + len(pull), columns] += coefficient * pull

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of Student's t over all limbs, up to a constant; by the middle frame."""
        cost = np.zeros(state.frames)
        if state.frames < 3:
            return cost
        second = np.diff(state.variation, n=2, axis=0) / self.std
        for limb in state.prior.skeleton.limbs:
            # Weighed by all of a limb's components together, as `add_to` does.
            cost[1:-1] += student_cost((second[:, limb] ** 2).sum(axis=1), DEGREES, 1)
        return cost


@dataclass(frozen=True, eq=False)
class BeliefTerm:
    """Independent normal distributions of the unknowns z, of unit size, and of the biases."""

    quadratic: QuadraticTerm
    bias_std: Array  # (1, B) [px]
    robust: ClassVar[bool] = False

    @classmethod
    def of(cls, frames: int, dof_count: int, bias_std: Array) -> "BeliefTerm":
        """The belief in F independent states of one frame, D unknowns z and B biases each."""
        builder = QuadraticBuilder(frames, dof_count + bias_std.shape[1])
        builder.add(slice(0, dof_count), (1.0,), 1.0)
        builder.add(slice(dof_count, None), (1.0,), bias_std)
        return cls(builder.term(), bias_std)

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add the term; annealing does not touch it."""
        self.quadratic.add_to(equations, state, temperature)

    def cost(self, state: ClipState) -> Array:
        """(F,) half the sum of squares."""
        squared = (state.variation**2).sum(-1) + ((state.bias / self.bias_std) ** 2).sum(-1)
        return np.asarray(0.5 * squared)


@dataclass(frozen=True)
class LimitTerm:
    """A one-sided spring on every hinge past its range."""

    std_rad: float = 0.03
    robust: ClassVar[bool] = False

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add a row for each hinge, zero within its range."""
        excess = self.excess(state)
        hinges = state.prior.skeleton.hinge_dofs
        past = (excess != 0.0) / self.std_rad
        equations.add_rows(excess, state.tangent_jacobian[:, hinges] * past[..., None])

    def cost(self, state: ClipState) -> Array:
        """(F,) half the sum of squares."""
        return np.asarray(0.5 * (self.excess(state) ** 2).sum(-1))

    def excess(self, state: ClipState) -> Array:
        """(F, H) how far each hinge is past its range [standard deviations]."""
        skeleton = state.prior.skeleton
        lower, upper = skeleton.limits[skeleton.hinge_dofs].T
        angles = state.posture.angles
        return np.asarray((angles - np.clip(angles, lower, upper)) / self.std_rad)
