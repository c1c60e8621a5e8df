"""Keyframes: frames whose posture a person, or a matched library, has given."""

from dataclasses import dataclass

from ..body.posture import Posture


@dataclass(frozen=True)
class Matched:
    """Where a keyframe comes from that nobody posed."""

    library: str
    """The library's identifier."""
    posture: str
    """Name of the library's posture that it is nearest to."""
    mirrored: bool
    """Whether with left and right exchanged."""
    confidence: float
    """How probably it is about right, 0 to 1."""


@dataclass(frozen=True, eq=False)
class Keyframe:
    """A posed frame."""

    index: int
    """Position in the clip, 0 for the first decoded frame."""
    posture: Posture
    """A single posture."""
    residual_m: float = 0.0
    """Mean distance [m] between the points it was read from and the fitted posture's; 0 where posed."""
    matched: Matched | None = None
    """What it was matched with; None for a keyframe that a person has posed, or has corrected."""
