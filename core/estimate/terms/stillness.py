"""Feet that stand, stand still: a heavy-tailed prior on the ankles' velocity.

A point that hardly moves is pulled to rest, one that moves is left alone, and no floor is assumed: a foot
that slides (a treadmill, a dance) moves, and is released. This is the Geman-McClure kernel on velocity,
c² v² / (c² + v²), whose weight falls to nothing for speeds well past c.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..clip_state import ClipState
from .term import NormalEquations

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StillnessTerm:
    """Slow named points stand still from frame to frame."""

    points: tuple[int, ...]
    """Indices of the principal points it is about."""
    step_s: Array
    """(F - 1,) time between frames [s]."""
    release_speed_m_s: float = 0.3
    """Speed at which a point is half released."""
    std_m: float = 0.002
    """How far a standing ankle wanders from frame to frame [m]."""

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add three rows for each point and pair of frames."""
        if state.frames < 2:
            return
        chosen = list(self.points)
        places = state.body.points(state.pose)[:, chosen]
        jacobian = state.body.points_jacobian(state.pose)[:, chosen] @ state.chain[:, None]
        travel = np.diff(places, axis=0)
        speed = np.linalg.norm(travel, axis=-1) / self.step_s[:, None]
        release = self.release_speed_m_s**2 / (self.release_speed_m_s**2 + speed**2)
        weight = (release**2 / self.std_m)[..., None]
        rows = len(chosen) * 3
        shape = (state.frames - 1, rows, -1)
        equations.add_rows(
            (travel * weight).reshape(-1, rows),
            (-jacobian[:-1] * weight[..., None]).reshape(shape),
            (jacobian[1:] * weight[..., None]).reshape(shape),
        )
