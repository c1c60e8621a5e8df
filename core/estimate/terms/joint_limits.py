"""Hinges stay within their range of motion: knees and elbows do not bend backwards."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array
from ..clip_state import ClipState
from .term import NormalEquations


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
