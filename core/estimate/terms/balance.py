"""A person who stands, steps or crouches keeps the body's center of mass about over the feet.

Nothing else in a single picture says as well how far the body leans toward the camera or away from it.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from ...arrays import Array
from ...body.center_of_mass import mass_weights
from ...body.kinematics import Body
from ...body.skeleton import SIDES
from ...body.soles import sole_places
from ...numerics.robust import student_cost, student_weight
from ..clip_state import ClipState
from .term import NormalEquations

DEGREES = 3.0
"""Of Student's t: whoever runs, leaps, kicks or leans on something is forgiven."""
STEP_M = 0.1
"""A foot that is higher above the other than this bears nothing."""


@dataclass(frozen=True, eq=False)
class BalanceTerm:
    """The horizontal way from the place between the feet that is nearest to the center of mass, to that."""

    body: Body
    std_m: float = 0.08
    """Half of what a foot is long, and what a step under way adds."""
    robust: ClassVar[bool] = True

    @cached_property
    def _weights(self) -> Array:
        return mass_weights(self.body.skeleton)

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add two rows for each frame."""
        residual, share, soles = self._residual(state)
        mass = np.einsum("p,fpid->fid", self._weights, self.body.points_jacobian(state.pose)[..., :2, :])
        feet = state.pose.places_jacobian(self._feet, soles)[..., :2, :]  # (F, 2, 2, D)
        jacobian = mass - (share[..., None, None] * feet).sum(axis=1)
        weight = np.sqrt(student_weight((residual**2).sum(-1), DEGREES, 2))[:, None]
        rows = (jacobian @ state.tangent_jacobian) / self.std_m
        equations.add_rows(residual * weight, rows * weight[..., None])

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of Student's t, up to a constant."""
        residual, _, _ = self._residual(state)
        return student_cost((residual**2).sum(-1), DEGREES, 2)

    @cached_property
    def _feet(self) -> tuple[int, ...]:
        names = {segment.name: segment.joint for segment in self.body.skeleton.segments}
        return tuple(names[f"foot.{side}"] for side in SIDES)

    def _residual(self, state: ClipState) -> tuple[Array, Array, Array]:
        """(F, 2) in standard deviations, (F, 2) share of each foot in the place, (F, 2, 3) soles' middles."""
        points = self.body.points(state.pose)
        mass = np.einsum("p,fpi->fi", self._weights, points[..., :2])
        soles = sole_places(self.body, state.pose).mean(axis=-2)
        first, way = soles[:, 0, :2], soles[:, 1, :2] - soles[:, 0, :2]
        along = ((mass - first) * way).sum(-1) / np.maximum((way**2).sum(-1), 1e-9)
        higher = soles[:, 1, 2] - soles[:, 0, 2]
        along = np.where(higher > STEP_M, 0.0, np.where(higher < -STEP_M, 1.0, np.clip(along, 0.0, 1.0)))
        share = np.stack([1.0 - along, along], axis=-1)
        place = (share[..., None] * soles[..., :2]).sum(axis=1)
        return (mass - place) / self.std_m, share, soles
