"""A person stands on the ground most of the time: the lower ankle is about as high above it as ever.

Where the camera looks at the feet from above, their height says how far away they are, which nothing else in
a single picture says as well.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Array, IndexArray
from ...numerics.robust import student_cost, student_weight
from ..clip_state import ClipState
from .term import NormalEquations

DEGREES = 3.0
"""Of Student's t: leaps and stairs are forgiven."""


@dataclass(frozen=True, eq=False)
class GroundTerm:
    """The height of the lower of some points."""

    points: tuple[int, ...]
    """Which of the principal points: the ankles."""
    height_m: float | Array
    """How high the lower one is while its foot is on the ground; one height or (F,)."""
    std_m: float = 0.03
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add one row for each frame."""
        residual, lower = self._residual(state)
        jacobian = state.body.points_jacobian(state.pose)[np.arange(state.frames), lower, 2]  # (F, D)
        weight = np.sqrt(student_weight(residual**2, DEGREES, 1))[:, None]
        rows = (jacobian[:, None] @ state.tangent_jacobian) / self.std_m
        equations.add_rows(residual[:, None] * weight, rows * weight[..., None])

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of Student's t, up to a constant."""
        residual, _ = self._residual(state)
        return student_cost(residual**2, DEGREES, 1)

    def _residual(self, state: ClipState) -> tuple[Array, IndexArray]:
        """(F,) in standard deviations, and which point it is."""
        heights = state.body.points(state.pose)[:, list(self.points), 2]
        lower = heights.argmin(axis=1)
        residual = (heights[np.arange(state.frames), lower] - self.height_m) / self.std_m
        return residual, np.array(self.points)[lower]
