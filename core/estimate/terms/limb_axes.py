"""Parts of the body against the shifts along their axes that their colors tell."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...observation.limb_axes import LimbAxes
from ..clip_state import ClipState
from .term import NormalEquations, student_weight

DEGREES = 4.0


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

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add a row for each part."""
        world, pixel = self.axes.points(state.pose, state.frame, self.share)
        residual = np.sum(self.direction * pixel, axis=-1) - self.place
        found = np.isfinite(residual)
        residual = np.where(found, residual, 0.0)
        variance = self.variance * temperature
        information = np.where(found, student_weight(residual**2 / variance, DEGREES, 1) / variance, 0.0)
        weight = np.sqrt(information)
        jacobian = self.axes.jacobian(state.pose, state.frame, world, self.direction) @ state.tangent_jacobian
        equations.add_rows(residual * weight, np.where(found[..., None], jacobian, 0.0) * weight[..., None])
