"""The contours of limbs and trunk against the edges found near them, along the contours' normals."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array, BoolArray
from ...numerics.robust import student_cost, student_weight
from ...observation.contours import SHARES, SIDES, ContourModel, ContourPrediction
from ..clip_state import ClipState
from .term import DEGREES, NormalEquations

SURFACE_SHARE = 0.2
"""Standard deviation of a part's contour as a whole, of its half-width: clothes, muscles."""
PIXEL_STD = 0.6
"""The same in pixels of the pictures: blur and light."""
ALIKE = len(SHARES) * len(SIDES)
"""The samples of a part err together: all of them weigh as much as one."""

FEWEST_SEEN = 3
"""Edges of a part that tell where it is: those of one side alone, or of one end, do not."""


@dataclass(frozen=True, eq=False)
class ContourTerm:
    """Compares every contour sample with the edge found near it."""

    model: ContourModel
    edge: Array
    """(F, N, 2) where the edge lies [px]; NaN where none was found."""
    normal: Array
    """(F, N, 2) across it."""
    variance: Array
    """(F, N) [px²]."""
    robust: ClassVar[bool] = True

    def parts_seen(self) -> BoolArray:
        """(F, O) whether enough edges of each part were found."""
        found = np.isfinite(self.edge[..., 0])
        return np.asarray(found.reshape(len(found), -1, ALIKE).sum(axis=-1) >= FEWEST_SEEN)

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add a row for each edge."""
        predicted = self.model.evaluate(state.pose, state.frame)
        residual, variance, found = self._residual(predicted)
        variance = variance * temperature
        information = np.where(found, student_weight(residual**2 / variance, DEGREES, 1) / variance, 0.0)
        weight = np.sqrt(information / ALIKE)
        jacobian = self.model.normal_jacobian(predicted, self.normal, state.pose) @ state.tangent_jacobian
        equations.add_rows(residual * weight, np.where(found[..., None], jacobian, 0.0) * weight[..., None])

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of Student's t over all edges, up to a constant."""
        residual, variance, found = self._residual(self.model.evaluate(state.pose, state.frame))
        squared = np.where(found, residual**2 / variance, 0.0)
        return np.asarray(student_cost(squared, DEGREES, 1).sum(-1) / ALIKE)

    def _residual(self, predicted: ContourPrediction) -> tuple[Array, Array, BoolArray]:
        """(F, N) distances from the edges [px], their variance [px²] and which edges were found."""
        residual = np.sum(self.normal * (predicted.pixel - self.edge), axis=-1)
        found = np.isfinite(residual)
        variance = self.variance + (SURFACE_SHARE * predicted.half_width) ** 2
        return np.where(found, residual, 0.0), variance, found
