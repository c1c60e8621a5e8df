"""Lines of sight: where on one a point may lie that hangs on another by a rigid part.

A point keeps its image exactly as long as it stays on the line from the camera through it, whatever the lens.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..footage.camera import Camera


@dataclass(frozen=True, eq=False)
class SightLine:
    """A line along which a view looks."""

    origin: Array
    """(3,) a place on it [m]: the camera's, where it is a camera's."""
    direction: Array
    """(3,) unit vector, in which depth increases."""

    @classmethod
    def to(cls, camera: Camera, place: Array) -> "SightLine":
        """The line of sight of a camera that stands still to a place (3,) [m]."""
        _, eye = camera.pose()
        return cls(np.asarray(eye), np.asarray(camera.sight(place)))

    def along_m(self, place: Array) -> float:
        """How far along the line a place (3,) lies from its origin [m]."""
        return float((place - self.origin) @ self.direction)

    def nearest(self, place: Array) -> Array:
        """The place on the line (3,) that is nearest to another (3,) [m]."""
        return np.asarray(self.origin + self.along_m(place) * self.direction)

    def off_m(self, place: Array) -> float:
        """Distance of a place (3,) from the line [m]."""
        return float(np.linalg.norm(place - self.nearest(place)))

    def at_distance(self, center: Array, radius_m: float) -> Array:
        """The two places on the line at a distance from a center, in order of depth.

        Where the line passes the center farther away, both are the place at that distance which is nearest to
        the line.

        Args:
            center: (3,) [m].
            radius_m: Distance from it [m].

        Returns:
            (2, 3) places, exactly at that distance.
        """
        foot = self.nearest(center)
        off = foot - center
        aside = float(np.linalg.norm(off))
        if aside >= radius_m:
            nearest = center + off * (radius_m / aside)
            return np.stack([nearest, nearest])
        half = float(np.sqrt(radius_m**2 - aside**2))
        return np.stack([foot - half * self.direction, foot + half * self.direction])

    def within(self, place: Array, center: Array, radii_m: tuple[float, float]) -> Array:
        """The place (3,) near the line whose distance from a center (3,) lies between two radii [m].

        It is the place on the line nearest to another (3,), or else the nearest to that at such a distance.
        """
        on_line = self.nearest(place)
        least, most = radii_m
        away = float(np.linalg.norm(on_line - center))
        if least <= away <= most:
            return on_line
        choices = self.at_distance(center, most if away > most else least)
        return np.asarray(min(choices, key=lambda choice: float(np.linalg.norm(choice - on_line))))
