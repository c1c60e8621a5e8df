"""Depths of the principal points near those of the prior (paper, eq. 9), which the image tells little of."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array
from ...footage.camera import Camera
from ...observation import depths
from ..clip_state import ClipState
from .term import NormalEquations


@dataclass(frozen=True, eq=False)
class DepthTerm:
    """d(θ) against d(θ_p)."""

    camera: Camera
    prior_depth: Array
    """(F, P) [m]."""
    std_m: float | Array = depths.DEPTH_STD_M
    """One for all or (F, 1)."""
    robust: ClassVar[bool] = False

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add one row for each point."""
        residual = self._residual(state)
        jacobian = depths.jacobian(state.body, self.camera, state.pose, state.frame) @ state.tangent_jacobian
        std_m = np.asarray(self.std_m)
        equations.add_rows(residual / std_m, jacobian / std_m[..., None])

    def cost(self, state: ClipState) -> Array:
        """(F,) half the sum of squares."""
        return np.asarray(0.5 * ((self._residual(state) / np.asarray(self.std_m)) ** 2).sum(-1))

    def _residual(self, state: ClipState) -> Array:
        """(F, P) [m]."""
        return np.asarray(
            depths.evaluate(state.body, self.camera, state.pose, state.frame) - self.prior_depth
        )
