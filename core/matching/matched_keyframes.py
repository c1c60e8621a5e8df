"""Keyframes that were found in the footage, put beside those that a person has posed."""

from collections.abc import Sequence
from dataclasses import replace

from ..body.posture import Posture
from ..prior.keyframes import Keyframe, Matched
from ..take.take import Take
from .candidates import MatchedFrame

NEAR_FRAMES = 2
"""Found keyframes keep farther than this from posed ones."""


def with_matched(take: Take, frames: Sequence[MatchedFrame], postures: Posture, library: str) -> Take:
    """The take with the chosen candidates of some frames: posed keyframes stay, found ones make room.

    Beside a posed keyframe a found one tells how the performer differs from the postures it was made of
    (`prior/performer_offset`).

    Args:
        take: The take; keyframes that were found earlier go.
        frames: Frames with candidates, the chosen one first.
        postures: (F,) the posture found in every frame of the clip.
        library: Identifier of where the postures are from.
    """
    posed = [keyframe.index for keyframe in take.keyframes if keyframe.matched is None]
    keyframes = {keyframe.index: keyframe for keyframe in take.keyframes if keyframe.matched is None}
    for frame in frames:
        index = _free_frame(frame.index, posed, postures.batch[0])
        if index is None or index in keyframes:
            continue
        chosen = frame.candidates[0]
        posture = chosen.posture if index == frame.index else postures[index]
        said = Matched(library, chosen.name, chosen.mirrored, chosen.confidence)
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
