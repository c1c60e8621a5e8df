"""Postures found in footage without posing, with the candidates of every proposed frame."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from ..body.posture import Posture
from ..footage.reading import Reading
from ..library.texts import COMPOSED
from ..matching.candidates import MatchedFrame
from ..prior.keyframes import Keyframe, Matched
from ..take.take import Take

NEAR_FRAMES = 2
"""Found keyframes keep farther than this from posed ones."""


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
    """Sentence for people: how sure it is, and what is doubtful."""
    contradictions: Mapping[int, tuple[str, ...]] = field(default_factory=dict)
    """Names of the markers and keypoints that no plausible posture explains, by index of a proposed frame."""
    library: str = COMPOSED
    """Identifier of the library that was matched, where only one was."""
    reading: Reading | None = None
    """The clip as read again with the postures telling where each marker is; None where the given reading
    holds."""


def with_found(take: Take, found: FoundPoses) -> Take:
    """The take with the found keyframes: posed ones stay, found ones near them move aside.

    Beside a posed keyframe a found one tells how the performer differs from the postures it was made of
    (`prior/performer_offset`).
    """
    posed = [keyframe.index for keyframe in take.keyframes if keyframe.matched is None]
    keyframes = {keyframe.index: keyframe for keyframe in take.keyframes if keyframe.matched is None}
    for frame in found.frames:
        index = _free_frame(frame.index, posed, found.postures.batch[0])
        if index is None or index in keyframes:
            continue
        chosen = frame.candidates[0]
        posture = chosen.posture if index == frame.index else found.postures[index]
        said = Matched(found.library, chosen.name, chosen.mirrored, chosen.confidence)
        keyframes[index] = Keyframe(index, posture, matched=said)
    return replace(take, keyframes=tuple(keyframes[index] for index in sorted(keyframes)))


def _free_frame(index: int, posed: Sequence[int], frames: int) -> int | None:
    """The frame itself or, near a posed keyframe, the nearest one that is far enough; None without one."""
    reach = range(-NEAR_FRAMES - 1, NEAR_FRAMES + 2)
    free = [
        index + step
        for step in sorted(reach, key=abs)
        if 0 <= index + step < frames and all(abs(index + step - other) > NEAR_FRAMES for other in posed)
    ]
    return free[0] if free else None
