"""Keyframes: frames with a given posture, posed by a person or matched with a library."""

from dataclasses import dataclass

from ..body.posture import Posture

COMPOSED = "composed"
"""Identifier that stands for a library where a posture is put together from the parts of several."""


@dataclass(frozen=True)
class Matched:
    """Origin of a matched keyframe: the library's posture."""

    library: str
    """The library's identifier."""
    posture: str
    """Name of the nearest posture of the library."""
    mirrored: bool
    """Whether left and right are exchanged."""
    confidence: float
    """Probability that it is about right, 0 to 1."""


@dataclass(frozen=True, eq=False)
class Keyframe:
    """A frame with a given posture."""

    index: int
    """Frame index in the clip, 0 for the first decoded frame."""
    posture: Posture
    """A single posture."""
    residual_m: float = 0.0
    """Mean distance [m] between the points it was read from and the fitted posture's; 0 where posed."""
    matched: Matched | None = None
    """The posture it was matched with; None for a keyframe that a person has posed or corrected."""
