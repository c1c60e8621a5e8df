"""All poses of a clip in one go: the likeliest postures where nobody has posed, shared by every caller."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..errors import InputError
from ..footage.reading import Reading
from ..library.library import Library
from ..library.texts import COMPOSED
from ..matching.candidates import MatchedFrame
from ..matching.library_match import prepare_library
from ..matching.match_input import match_input
from ..progress import Job
from ..take.take import Take
from .found_poses import FoundPoses
from .match_clip import match_clip


def pose_clip(
    take: Take,
    reading: Reading,
    libraries: Sequence[Library],
    floor_m: float | None = None,
    keyframe_count: int | None = None,
    between: tuple[int, int] | None = None,
    frames: Sequence[int] | None = None,
) -> Job[FoundPoses]:
    """Find the postures of a clip that nobody posed.

    Args:
        take: The take; what is posed of it holds, what was found of it earlier is not used.
        reading: The clip as `read_footage` has read it.
        libraries: What is known of postures: each limb may come from another one.
        floor_m: Height of the floor in the world [m]; None where it is not known.
        keyframe_count: Number of frames to find keyframes at; 10 per 100 frames where None.
        between: First and last frame of the clip to look at, both posed; the whole clip where None.
        frames: Indices of the frames to find keyframes at, instead of `keyframe_count` proposed ones.

    Yields:
        Progress.

    Returns:
        The postures; there always are some, with a confidence that says how far to trust them.

    Raises:
        InputError: There is no library, none has a posture, or neither a marker nor a keypoint is seen.
    """
    usable = [library for library in libraries if library.postures]
    if not usable:
        raise InputError("no keyframe library with a posture is given; at least one is needed to pose with")
    given = match_input(take, reading, keyframe_count)
    cost = [prepare_library(given, library).coarse_pass.cost for library in usable]
    nearest = usable[int(np.argmin(cost))]
    found = yield from match_clip(take, reading, nearest, floor_m, keyframe_count)
    at = found.frames if frames is None else tuple(_at(found, index) for index in sorted(set(frames)))
    return replace(found, frames=at, library=COMPOSED)


def _at(found: FoundPoses, index: int) -> MatchedFrame:
    """The candidates of a frame, or its posture with what is known of the nearest frame's."""
    near = min(found.frames, key=lambda frame: abs(frame.index - index))
    if near.index == index:
        return near
    posture = replace(near.candidates[0], posture=found.postures[index])
    return MatchedFrame(index, (posture,))
