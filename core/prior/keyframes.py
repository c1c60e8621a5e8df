"""Keyframes: frames with a given posture, posed by a person or found in the footage."""

from dataclasses import dataclass
from typing import Annotated

from ..body.posture import Posture
from ..files.kinds import Number, Text
from ..files.records import Record
from ..library.several_libraries import COMPOSED

DOUBTFUL = 0.5
"""Confidence below which a found keyframe is doubtful: more likely wrong than about right."""


LONGEST_NAME = 200
"""Characters of a library's or a posture's name."""
Name = Annotated[str, Text(LONGEST_NAME, f"a name of at most {LONGEST_NAME} characters")]


@dataclass(frozen=True)
class Matched(Record):
    """Origin of a found keyframe: the posture of a library that it resembles."""

    library: Name
    """Identifier of the library that was matched, or `COMPOSED` where parts of several are put together."""
    posture: Name
    """Name of the nearest posture of the library."""
    mirrored: bool
    """Whether left and right are exchanged."""
    confidence: Annotated[float, Number(0.0, 1.0)]
    """Probability that it is about right, 0 to 1."""

    @property
    def is_doubtful(self) -> bool:
        """Whether the keyframe is worth a check."""
        return self.confidence < DOUBTFUL

    @property
    def is_composed(self) -> bool:
        """Whether parts of several libraries were put together, for this performer in this footage."""
        return self.library == COMPOSED


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
    """What was found; None for a keyframe that a person has posed or corrected."""
