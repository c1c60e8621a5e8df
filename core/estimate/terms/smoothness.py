"""The motion departs smoothly from the prior, with bursts: heavy-tailed second differences, limb by limb.

A kick or a sudden stop is an acceleration far beyond the usual in one limb for a few frames. Student's t
distribution allows for it without loosening the rest of the clip (Lange, Little & Taylor 1989).
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array
from ...numerics.robust import student_cost, student_weight
from ..clip_state import ClipState
from .term import DEGREES, NormalEquations

SECOND_DIFFERENCE = (1.0, -2.0, 1.0)


@dataclass(frozen=True, eq=False)
class SmoothnessTerm:
    """Second differences of the unknowns z, whose usual size is one at 30 frames a second."""

    std: float
    """Usual size at the clip's own pace."""
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
