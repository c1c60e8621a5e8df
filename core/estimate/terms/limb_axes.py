"""Parts of the body against the shifts along their axes that their colors tell."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array, BoolArray
from ...observation.limb_axes import LimbAxes
from ..clip_state import ClipState
from .drift import add_drift, drift, drift_cost
from .term import NormalEquations


@dataclass(frozen=True, eq=False)
class AxialTerm:
    """Compares where parts are along their axes with where their colors are seen."""

    axes: LimbAxes
    share: Array
    """(F, O) the point of each part's length that the colors say most of."""
    place: Array
    """(F, O) where it is seen, along the direction [px]; NaN where nothing was found."""
    direction: Array
    """(F, O, 2) unit direction of the axis."""
    variance: Array
    """(F, O) [px²]."""
    kept: Array
    """(F - 1, 1) share of an error that is left in the next frame."""
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add a row for each part, with an error that lasts."""
        world, error, std, found = self._errors(state)
        jacobian = self.axes.jacobian(state.pose, state.frame, world, self.direction)
        jacobian = np.where(found[..., None], jacobian / std[..., None], 0.0)
        rows = drift(error[..., None], found, self.kept, temperature)
        add_drift(equations, jacobian[:, :, None], rows, state.tangent_jacobian)

    def cost(self, state: ClipState) -> Array:
        """(F,) see `drift_cost`."""
        _, error, _, found = self._errors(state)
        return drift_cost(error[..., None], found, self.kept)

    def _errors(self, state: ClipState) -> tuple[Array, Array, Array, BoolArray]:
        """The axes' points (F, O, 3) [m], errors in standard deviations, these [px], and which are known."""
        world, pixel = self.axes.points(state.pose, state.frame, self.share)
        std = np.sqrt(self.variance)
        error = (np.sum(self.direction * pixel, axis=-1) - self.place) / std
        return world, error, std, np.isfinite(error)
