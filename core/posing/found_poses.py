"""Postures found in footage without posing, with the candidates of every proposed frame."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ..body.posture import Posture
from ..footage.reading import Reading
from ..library.several_libraries import COMPOSED
from ..matching.candidates import MatchedFrame
from ..matching.matched_keyframes import with_matched
from ..take.take import Take


@dataclass(frozen=True, eq=False)
class FoundPoses:
    """The most probable postures of a clip that nobody posed."""

    frames: tuple[MatchedFrame, ...]
    """The frames proposed for keyframes, in order, with their candidates, the chosen one first."""
    postures: Posture
    """(F,) the posture in every frame of the clip."""
    fit: float
    """Mean share of the footage that is explained, 0 to 1."""
    floor_m: float
    """Height of the floor that the performer stands on [m]."""
    reason: str
    """Sentence for people: how much of the footage is explained. Which frames are doubtful their candidates
    say."""
    contradictions: Mapping[int, tuple[str, ...]] = field(default_factory=dict)
    """Names of the markers and keypoints that no plausible posture explains, by index of a proposed frame."""
    library: str = COMPOSED
    """Identifier of the library that was matched, where only one was."""
    reading: Reading | None = None
    """The clip as read again with the postures telling where each marker is; None where the given reading
    holds."""
    between: tuple[int, int] | None = None
    """First and last frame that were looked at; None for the whole clip."""


def with_found(take: Take, found: FoundPoses) -> Take:
    """The take with the found keyframes, see `with_matched`; earlier ones stay where none was sought."""
    changed = with_matched(take, found.frames, found.postures, found.library)
    if found.between is None:
        return changed
    first, last = found.between
    here = {key.index: key for key in changed.keyframes}
    kept = {key.index: key for key in take.keyframes if not first <= key.index <= last}
    return replace(take, keyframes=tuple(each for _, each in sorted((here | kept).items())))
