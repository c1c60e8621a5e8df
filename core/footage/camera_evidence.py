"""What a picture shows of the camera that took it: lines of buildings, and upright things of known length."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array

CLICK_STD_PX = 1.5
"""Standard deviation of a click, or of a line's end drawn by hand [px]."""
PERSON_LENGTH_STD, PERSON_LEAN_STD_RAD = 0.02, float(np.radians(3.0))
"""Someone who stands or walks upright: share by which they are shorter than their stature or taller, as heads
rise and fall by 3 % in every step, and lean to any side."""
COMMON_LEAN_RAD = float(np.radians(2.5))
"""Lean that one person has at all moments alike: heads lie in front of ankles, and walkers lean forward."""
STATURE_STD = 0.015
"""Share by which a stated stature is off throughout: shoes, hair, and what people say of themselves."""
THING_LENGTH_STD, THING_LEAN_STD_RAD = 0.005, float(np.radians(0.5))
"""The same of things that were built upright and measured."""


def no_lines() -> Array:
    """No line at all, (0, 2, 2)."""
    return np.zeros((0, 2, 2))


@dataclass(frozen=True, eq=False)
class Uprights:
    """N upright things of known length that stand on the floor, or a performer at N moments."""

    lower_px: Array
    """(N, 2) the lower point in the picture [px]."""
    upper_px: Array
    """(N, 2) the point above it [px]."""
    lower_m: Array
    """(N,) height of the lower point above the floor [m]."""
    length_m: Array
    """(N,) length between the two [m]."""
    pixel_std: Array
    """(N,) standard deviation of a point in the picture [px]."""
    length_std: Array
    """(N,) share by which each length may be off."""
    lean_std_rad: Array
    """(N,) lean to the side."""
    common_std: float = 0.0
    """Share by which all lengths may be off together."""
    common_lean_rad: float = 0.0
    """Lean that all may have together, as somebody who walks to one side has."""
    doubtful: bool = False
    """Whether single ones may be far off, as where nobody has looked at them."""

    @classmethod
    def none(cls) -> "Uprights":
        """None at all."""
        points, numbers = np.zeros((0, 2)), np.zeros(0)
        return cls(points, points, numbers, numbers, numbers, numbers, numbers)

    @classmethod
    def persons(cls, ground_px: ArrayLike, crown_px: ArrayLike, stature_m: float) -> "Uprights":
        """Someone who stands upright at N places, clicked on.

        Args:
            ground_px: (N, 2) the floor between the feet [px].
            crown_px: (N, 2) the top of the head [px].
            stature_m: Body height [m].
        """
        return cls._standing(
            ground_px,
            crown_px,
            stature_m,
            PERSON_LENGTH_STD,
            PERSON_LEAN_STD_RAD,
            STATURE_STD,
            COMMON_LEAN_RAD,
        )

    @classmethod
    def things(cls, lower_px: ArrayLike, upper_px: ArrayLike, length_m: ArrayLike) -> "Uprights":
        """Things of known lengths (N,) [m] that stand on the floor, as doors, by their ends (N, 2) [px]."""
        return cls._standing(lower_px, upper_px, length_m, THING_LENGTH_STD, THING_LEAN_STD_RAD, 0.0, 0.0)

    @classmethod
    def _standing(
        cls,
        lower_px: ArrayLike,
        upper_px: ArrayLike,
        length_m: ArrayLike,
        length_std: float,
        lean_std_rad: float,
        common_std: float,
        common_lean_rad: float,
    ) -> "Uprights":
        lower = np.array(lower_px, dtype=np.float64).reshape(-1, 2)
        upper = np.array(upper_px, dtype=np.float64).reshape(-1, 2)
        ones = np.ones(len(lower))
        return cls(
            lower,
            upper,
            0.0 * ones,
            np.broadcast_to(np.asarray(length_m, dtype=np.float64), ones.shape),
            CLICK_STD_PX * ones,
            length_std * ones,
            lean_std_rad * ones,
            common_std,
            common_lean_rad,
        )

    def __len__(self) -> int:
        """How many there are."""
        return len(self.lower_px)

    def __add__(self, other: "Uprights") -> "Uprights":
        """Both together; what may be off in common is taken to be the same of both."""
        if not len(self) or not len(other):
            return self if len(self) else other

        def joined(name: str) -> Array:
            return np.concatenate([getattr(self, name), getattr(other, name)])

        return Uprights(
            joined("lower_px"),
            joined("upper_px"),
            joined("lower_m"),
            joined("length_m"),
            joined("pixel_std"),
            joined("length_std"),
            joined("lean_std_rad"),
            common_std=max(self.common_std, other.common_std),
            common_lean_rad=max(self.common_lean_rad, other.common_lean_rad),
            doubtful=self.doubtful or other.doubtful,
        )


@dataclass(frozen=True, eq=False)
class CameraEvidence:
    """Lines in the picture, each given by its two ends [px], and upright things of known length."""

    vertical: Array = field(default_factory=no_lines)
    """(V, 2, 2) plumb in the world: door frames, corners of walls."""
    along: Array = field(default_factory=no_lines)
    """(A, 2, 2) level and parallel to each other in the world: on the floor, or on a wall."""
    across: Array = field(default_factory=no_lines)
    """(C, 2, 2) level and at right angles to those."""
    uprights: Uprights = field(default_factory=Uprights.none)
