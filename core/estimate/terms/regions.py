"""The markers' image regions against their prediction: centroid and second moments, in pixels.

A second-moment residual is turned into the observed region's own axes and divided by twice the mean
deviation along them, the linearized difference of matrix square roots: three numbers in pixels, with no
angle to wrap and nothing singular when the region is round (instead of S_θ and S_λ, paper eqs 5 and 6).
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array
from ...evidence.regions import (
    FEATURES,
    ObservedRegions,
    RegionModel,
    RegionNoise,
    RegionPrediction,
    feature_rows,
    missing_variance,
)
from ...numerics.robust import DEGREES, student_cost, student_weight
from ..clip_state import ClipState
from .term import NormalEquations

GROUPS = (slice(0, 2), slice(2, FEATURES))  # rows that are outliers together: centroid and shape
CONTRADICTED = 20.0  # cost of a marker that is seen where it should be hidden


@dataclass(frozen=True, eq=False)
class RegionTerm:
    """Compares every visible marker with its prediction."""

    model: RegionModel
    observed: ObservedRegions
    noise: RegionNoise
    width_px: Array  # (F, M) mean half-width of each marker's limb in the image [px]
    distrust: Array  # (M,) factor of the noise of each marker's regions
    area_ratio: Array  # (M,) area of each marker's unhidden region, relative to the predicted one
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add five rows for each marker that is seen and predicted to be seen."""
        predicted = self.model.evaluate(state.pose, state.frame, jacobian=True)
        residual, jacobian = feature_rows(self.observed, predicted)
        assert jacobian is not None
        count = len(self.model.placements)
        residual = residual + state.bias.reshape(state.frames, count, FEATURES)
        weight = np.sqrt(self.weights(residual, predicted, temperature))  # (F, M, 5)
        residual = np.where(weight > 0.0, residual, 0.0) * weight
        jacobian = (jacobian @ state.tangent_jacobian[:, None]) * weight[..., None]
        jacobian[weight == 0.0] = 0.0  # a prediction behind the camera is no number
        shape = (state.frames, count * FEATURES)
        by_posture = jacobian.reshape(*shape, jacobian.shape[-1])
        equations.add_biased_rows(residual.reshape(shape), by_posture, weight.reshape(shape))

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of Student's t over all markers, up to a constant.

        A marker that is seen where the posture hides it costs as much as one that is far off.
        """
        predicted = self.model.evaluate(state.pose, state.frame)
        residual, _ = feature_rows(self.observed, predicted)
        residual = residual + state.bias.reshape(residual.shape)
        information = self._information(residual, predicted)
        squared = np.nan_to_num(residual) ** 2 * information
        cost = np.zeros(squared.shape[:2])
        for group in GROUPS:
            cost += student_cost(squared[..., group].sum(-1), DEGREES, group.stop - group.start)
        contradicted = np.isfinite(self.observed.centroid[..., 0]) & (information[..., 0] == 0.0)
        return np.asarray(np.where(contradicted, CONTRADICTED * self.observed.quality, cost).sum(-1))

    def weights(self, residual: Array, predicted: RegionPrediction, temperature: float) -> Array:
        """Information (F, M, 5) of each row [1/px²]; zero for what is not compared."""
        information = self._information(residual, predicted) / temperature
        squared = np.where(information > 0.0, np.nan_to_num(residual) ** 2 * information, 0.0)
        for group in GROUPS:
            size = group.stop - group.start
            information[..., group] *= student_weight(squared[..., group].sum(-1), DEGREES, size)[..., None]
        return np.asarray(information)

    def _information(self, residual: Array, predicted: RegionPrediction) -> Array:
        """The same before outliers are downweighted."""
        usable = np.isfinite(residual).all(-1) & (predicted.visible > self.noise.least_visible)
        trust = np.clip(self.observed.quality * predicted.visible, 1e-3, 1.0)
        variance = self.noise.pixel_std_px**2 + self.noise.surface_std(self.width_px) ** 2
        variance = variance * self.distrust[:, None] ** 2
        variance = variance + missing_variance(self.observed.area, self.area_ratio, predicted)
        variance = variance + self.observed.variance
        return np.asarray(np.where(usable[..., None], trust[..., None] / variance, 0.0))
