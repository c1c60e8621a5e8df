"""Feet that stand, stand still: a heavy-tailed prior on the lower ankle's velocity.

A foot that hardly moves in the image, and is not the higher one, stands: it is pulled to rest, along the line
of sight too, where the image sees no motion. One that moves in the image is left alone, and no floor is
assumed: a foot that slides (a treadmill, a dance) moves, and is released. Each row is multiplied by the
weight of Geman and McClure's (1987) kernel, (1 + v² / c²)⁻², which falls to nothing for speeds well past c;
once for the speed and once for the height.
"""

from dataclasses import dataclass
from typing import ClassVar

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
    robust: ClassVar[bool] = True

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

    def cost(self, state: ClipState) -> Array:
        """(F,) what it costs the points to move, which is bounded; that of the later frame of each pair."""
        cost = np.zeros(state.frames)
        if state.frames < 2:
            return cost
        places = state.body.points(state.pose)[:, list(self.points)]
        travel, middle = np.diff(places, axis=0), 0.5 * (places[1:] + places[:-1])
        speed, height = self._moving(travel, middle, state.frame[1:])
        farthest = self.release_speed_m_s * self.step_s[:, None] / self.std_m
        # The integral of a row times its weight, ∫ x (1 + x²)⁻⁴ dx.
        moved = farthest**2 * (1.0 - (1.0 + speed**2) ** -3.0) / 6.0
        cost[1:] = (moved * _kernel(height) ** 2).sum(-1)
        return cost

    def _standing(self, travel: Array, middle: Array, frame: IndexArray) -> Array:
        """(F - 1, points) how far each point is taken to stand, 0 to 1."""
        speed, height = self._moving(travel, middle, frame)
        return np.asarray(_kernel(speed) * _kernel(height))

    def _moving(self, travel: Array, middle: Array, frame: IndexArray) -> tuple[Array, Array]:
        """(F - 1, points) speed and height, in those at which rows count a quarter."""
        sight = self.camera.sight(middle, frame[:, None])
        along = np.sum(travel * sight, axis=-1, keepdims=True) * sight
        counted = travel - (1.0 - self.depth_share) * along
        speed = np.linalg.norm(counted, axis=-1) / self.step_s[:, None]
        height = middle[..., 2] - middle[..., 2].min(axis=1, keepdims=True)
        return speed / self.release_speed_m_s, height / self.release_height_m


def _kernel(x: Array) -> Array:
    """Weight of the Geman-McClure kernel, a quarter at 1."""
    return np.asarray((1.0 + x**2) ** -2.0)
