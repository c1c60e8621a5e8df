"""The contours of limbs and trunk against the edges found near them, along the contours' normals."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array, BoolArray
from ...evidence.contours import SHARES, SIDES, ContourModel, ContourPrediction, LimbAxes
from ...numerics.robust import DEGREES, student_cost, student_weight
from ..clip_state import ClipState
from .term import NormalEquations, add_errors, errors_cost

SURFACE_SHARE = 0.2  # standard deviation of a part's contour as a whole, of its half-width: clothes, muscles
PIXEL_STD = 0.6  # the same in pixels of the pictures: blur and light
ALIKE = len(SHARES) * len(SIDES)  # the samples of a part err together: all of them weigh as much as one


@dataclass(frozen=True, eq=False)
class ContourTerm:
    """Compares every contour sample with the edge found near it."""

    model: ContourModel
    edge: Array  # (F, N, 2) where the edge lies [px]; NaN where none was found
    normal: Array  # (F, N, 2) across it
    variance: Array  # (F, N) [px²]
    robust: ClassVar[bool] = True

    def parts_seen(self) -> BoolArray:
        """(F, O) whether enough edges of each part were found."""
        found = np.isfinite(self.edge[..., 0])
        return np.asarray(found.reshape(len(found), -1, ALIKE).sum(axis=-1) >= 3)

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


@dataclass(frozen=True, eq=False)
class AxialTerm:
    """Compares where parts are along their axes with where their colors are seen."""

    axes: LimbAxes
    share: Array  # (F, O) the point of each part's length that the colors say most of
    place: Array  # (F, O) where it is seen, along the direction [px]; NaN where nothing was found
    direction: Array  # (F, O, 2) unit direction of the axis
    variance: Array  # (F, O) [px²]
    kept: Array  # (F - 1, 1) share of an error that is left in the next frame
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add a row for each part, with an error that lasts."""
        world, error, std, found = self._errors(state)
        jacobian = self.axes.jacobian(state.pose, state.frame, world, self.direction)
        jacobian = np.where(found[..., None], jacobian / std[..., None], 0.0)[:, :, None]
        add_errors(
            equations, error[..., None], found, jacobian, self.kept, temperature, state.tangent_jacobian
        )

    def cost(self, state: ClipState) -> Array:
        """(F,) see `errors_cost`."""
        _, error, _, found = self._errors(state)
        return errors_cost(error[..., None], found, self.kept)

    def _errors(self, state: ClipState) -> tuple[Array, Array, Array, BoolArray]:
        """The axes' points (F, O, 3) [m], errors in standard deviations, these [px], and which are known."""
        world, pixel = self.axes.points(state.pose, state.frame, self.share)
        std = np.sqrt(self.variance)
        error = (np.sum(self.direction * pixel, axis=-1) - self.place) / std
        return world, error, std, np.isfinite(error)
