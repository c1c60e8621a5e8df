"""Keyframes: frames whose posture a person, or a matched library, has given."""

from dataclasses import dataclass

from ..body.posture import Posture


@dataclass(frozen=True, eq=False)
class Keyframe:
    """A posed frame."""

    index: int
    """Position in the clip, 0 for the first decoded frame."""
    posture: Posture
    """A single posture."""
    residual_m: float = 0.0
    """Mean distance [m] between the points it was read from and the fitted posture's; 0 where posed."""
