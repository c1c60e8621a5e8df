"""A posture that a frame may show."""

from dataclasses import dataclass

from ..body.posture import Posture


@dataclass(frozen=True, eq=False)
class Candidate:
    """A library's posture in its place before the camera."""

    posture: Posture
    """Of the take's body, in the world."""
    name: str
    """The library's posture that it is, or is nearest to."""
    mirrored: bool
    """Whether with left and right exchanged."""
    confidence: float
    """How probably it is about right, 0 to 1."""


@dataclass(frozen=True, eq=False)
class MatchedFrame:
    """What one frame shows."""

    index: int
    """Position in the clip."""
    candidates: tuple[Candidate, ...]
    """The chosen one first, then what else it may be."""
