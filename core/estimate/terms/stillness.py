"""Feet that stand, stand still: a heavy-tailed prior on the lower ankle's velocity.

A foot that hardly moves in the image, and is not the higher one, stands: it is pulled to rest, along the line
of sight too, where the image sees no motion. One that moves in the image is left alone, and no floor is
assumed: a foot that slides (a treadmill, a dance) moves, and is released. Each row is multiplied by the
weight of Geman and McClure's (1987) kernel, (1 + v² / c²)⁻², which falls to nothing for speeds well past c;
once for the speed and once for the height.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array, IndexArray
from ...footage.camera import Camera
from ..clip_state import ClipState
from .term import NormalEquations


@dataclass(frozen=True, eq=False)
class StillnessTerm:
    """Slow named points stand still from frame to frame."""

    camera: Camera
    points: tuple[int, ...]
    """Indices of the principal points it is about."""
    step_s: Array
    """(F - 1,) time between frames [s]."""
    release_speed_m_s: float = 0.2
    """Speed across the line of sight, c, at which a point's rows count a quarter."""
    depth_share: float = 0.3
    """How much motion along the line of sight counts to that speed."""
    release_height_m: float = 0.04
    """Height above the lowest of the points at which a point's rows count a quarter."""
    std_m: float = 0.003
    """How far a standing ankle wanders from frame to frame [m]."""

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add three rows for each point and pair of frames."""
        if state.frames < 2:
            return
        chosen = list(self.points)
        places = state.body.points(state.pose)[:, chosen]
        jacobian = state.body.points_jacobian(state.pose)[:, chosen] @ state.tangent_jacobian[:, None]
        travel = np.diff(places, axis=0)
        middle = 0.5 * (places[1:] + places[:-1])
        weight = self._standing(travel, middle, state.frame[1:])[..., None] / self.std_m
        rows = len(chosen) * 3
        shape = (state.frames - 1, rows, -1)
        equations.add_rows(
            (travel * weight).reshape(-1, rows),
            (-jacobian[:-1] * weight[..., None]).reshape(shape),
            (jacobian[1:] * weight[..., None]).reshape(shape),
        )

    def _standing(self, travel: Array, middle: Array, frame: IndexArray) -> Array:
        """(F - 1, points) how far each point is taken to stand, 0 to 1."""
        sight = self.camera.sight(middle, frame[:, None])
        along = np.sum(travel * sight, axis=-1, keepdims=True) * sight
        counted = travel - (1.0 - self.depth_share) * along
        speed = np.linalg.norm(counted, axis=-1) / self.step_s[:, None]
        height = middle[..., 2] - middle[..., 2].min(axis=1, keepdims=True)
        return np.asarray(_kernel(speed / self.release_speed_m_s) * _kernel(height / self.release_height_m))


def _kernel(x: Array) -> Array:
    """Weight of the Geman-McClure kernel, a quarter at 1."""
    return np.asarray((1.0 + x**2) ** -2.0)
