"""All poses of a clip in one go: the likeliest postures where nobody has posed, shared by every caller."""

from collections.abc import Sequence

from ..footage.reading import Reading
from ..library.library import Library
from ..matching.candidates import Candidate, MatchedFrame
from ..matching.library_match import LibraryMatch
from ..matching.match_take import match_take
from ..progress import Job
from ..take.take import Take
from .found_poses import FoundPoses


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
    choice = yield from match_take(take, reading, libraries, floor_m, keyframe_count)
    match = choice.match
    if match is None:
        choice = yield from match_take(take, reading, [choice.ranking[0][0]], floor_m, keyframe_count)
        match = choice.match
    assert match is not None
    found = match.frames if frames is None else tuple(_at(match, index) for index in sorted(set(frames)))
    return FoundPoses(found, match.postures, match.fit, match.floor_m, choice.reason, reading=choice.reading)


def _at(match: LibraryMatch, index: int) -> MatchedFrame:
    """The candidates of a frame, or its posture with what is known of the nearest frame's."""
    near = min(match.frames, key=lambda frame: abs(frame.index - index))
    if near.index == index:
        return near
    said = near.candidates[0]
    return MatchedFrame(index, (Candidate(match.postures[index], said.name, said.mirrored, said.confidence),))
