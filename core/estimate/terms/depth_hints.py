"""Hints of depth: how a network guesses the body's links to lean toward or away from the camera.

Such guesses are off alike for many frames. A keyframe says by how much, so that near keyframes they add
little, and between distant ones, where nothing else tells of depth, much.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array, BoolArray
from ...observation.depth_links import DepthLinks
from ...observation.keypoints import KeypointModel
from ..clip_state import ClipState
from .drift import add_drift, drift, drift_cost
from .term import NormalEquations


@dataclass(frozen=True, eq=False)
class DepthHintTerm:
    """Compares the depths of all links with what they are expected to be by the network's guess."""

    model: KeypointModel
    links: DepthLinks
    expected: Array
    """(F, L) depth of each link by its guess [m]; NaN where there is none."""
    std_m: Array
    """(F, L) its error; infinite for what is not believed."""
    kept: Array
    """(F - 1, 1) share of an error that is left in the next frame."""
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add one row for each link."""
        error, used = self._errors(state)
        rows = drift(error[..., None], used, self.kept, temperature)
        jacobian = self.links.jacobian(self.model, state.pose, state.frame)
        jacobian *= np.where(used, 1.0 / self.std_m, 0.0)[..., None]
        add_drift(equations, jacobian[:, :, None], rows, state.tangent_jacobian)

    def cost(self, state: ClipState) -> Array:
        """(F,) see `drift_cost`."""
        error, used = self._errors(state)
        return drift_cost(error[..., None], used, self.kept)

    def _errors(self, state: ClipState) -> tuple[Array, BoolArray]:
        """(F, L) errors in standard deviations, and which are known."""
        error = (self.links.depths(self.model, state.pose, state.frame) - self.expected) / self.std_m
        return error, np.isfinite(error) & np.isfinite(self.std_m)
