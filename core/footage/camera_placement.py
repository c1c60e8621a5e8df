"""Where a camera stands and how it is held: height above the floor, tilt and roll.

Only these three and the lens say anything of the floor in the picture. The place on the floor and the heading
are a choice of the world's axes: they stay as they are.
"""

from dataclasses import dataclass
from math import atan2, cos, hypot, sin

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array

STRAIGHT_DOWN = 1e-6
"""Horizontal share of a viewing direction below which it has no heading."""


@dataclass(frozen=True)
class CameraPlacement:
    """Height and attitude of a camera over the floor z = 0."""

    height_m: float
    """Above the floor [m]."""
    tilt_rad: float
    """Of the viewing direction above the horizon; negative where the camera looks down."""
    roll_rad: float
    """About the viewing direction, counterclockwise as the camera's operator sees it: the picture then leans
    clockwise."""

    @classmethod
    def of(cls, matrix_world: ArrayLike) -> "CameraPlacement":
        """The placement of a camera's pose (4, 4), camera to world."""
        matrix = np.asarray(matrix_world, dtype=np.float64)
        right, up, back = matrix[2, :3]  # the world's up in the camera's axes
        level = hypot(right, up)
        tilt = atan2(-back, level)
        if level < STRAIGHT_DOWN:  # without a heading there is no roll
            return cls(float(matrix[2, 3]), tilt, 0.0)
        return cls(float(matrix[2, 3]), tilt, atan2(right, up))

    def rotation(self, heading_rad: float = 0.0) -> Array:
        """The camera's orientation (3, 3), its axes as columns: turned about Z, tilted, rolled."""
        tilted, rolled = self.tilt_rad, self.roll_rad
        turn = np.array(
            [
                [cos(heading_rad), -sin(heading_rad), 0.0],
                [sin(heading_rad), cos(heading_rad), 0.0],
                [0.0, 0.0, 1.0],
            ]
        )
        lift = np.array(
            [[1.0, 0.0, 0.0], [0.0, -sin(tilted), -cos(tilted)], [0.0, cos(tilted), -sin(tilted)]]
        )
        roll = np.array([[cos(rolled), -sin(rolled), 0.0], [sin(rolled), cos(rolled), 0.0], [0.0, 0.0, 1.0]])
        return np.asarray(turn @ lift @ roll)

    def matrix(self, place: tuple[float, float] = (0.0, 0.0), heading_rad: float = 0.0) -> Array:
        """The pose (4, 4), camera to world, above a place on the floor [m].

        Args:
            place: Where on the floor [m].
            heading_rad: About the world's Z, counterclockwise from looking along +Y.
        """
        pose = np.eye(4)
        pose[:3, :3] = self.rotation(heading_rad)
        pose[:3, 3] = *place, self.height_m
        return pose

    def applied_to(self, matrix_world: ArrayLike) -> Array:
        """A pose (4, 4) with this placement that keeps the heading and the place on the floor of another."""
        before = np.asarray(matrix_world, dtype=np.float64)
        return self.matrix((float(before[0, 3]), float(before[1, 3])), heading_rad(before))


def heading_rad(matrix_world: ArrayLike) -> float:
    """Heading of a camera's pose (4, 4) or orientation (3, 3) about the world's Z, 0 along +Y [rad]."""
    matrix = np.asarray(matrix_world, dtype=np.float64)
    ahead = -matrix[:2, 2]
    if hypot(*ahead) < STRAIGHT_DOWN:  # what is up in the picture lies ahead on the floor, or behind
        ahead = matrix[:2, 1] * (1.0 if matrix[2, 2] > 0.0 else -1.0)
    return atan2(-float(ahead[0]), float(ahead[1]))
