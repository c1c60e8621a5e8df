"""Prior belief in one frame's posture and in the biases of its features."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array
from ..clip_state import ClipState
from .quadratic import QuadraticBuilder, QuadraticTerm
from .term import NormalEquations


@dataclass(frozen=True, eq=False)
class BeliefTerm:
    """Independent normal distributions of the unknowns z, of unit size, and of the biases."""

    quadratic: QuadraticTerm
    bias_std: Array
    """(1, B) [px]."""
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
