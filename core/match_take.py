"""From a take and libraries to the postures its footage shows: what command line and Blender share."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from .errors import InputError
from .footage.reading import Reading
from .library.library import Library
from .prior.keyframes import Keyframe, Matched
from .prior.matching.match import LibraryMatch, Sought, match_library
from .prior.speed import marker_speed, propose_keyframes
from .progress import Job, Progress, within
from .take import Take

LEAST_FIT = 0.45
"""Footage of which less is explained shows something else than any of the libraries."""
NEAR_FRAMES = 2
"""A posed keyframe this near makes a matched one needless."""


@dataclass(frozen=True, eq=False)
class LibraryChoice:
    """Which library fits footage, and how."""

    ranking: tuple[tuple[Library, float], ...]
    """Every library with the probability that it is the one, the likeliest first; what is missing to 1 is the
    probability that none is."""
    match: LibraryMatch | None
    """The likeliest library's match; None where none fits."""
    reason: str
    """For people: which, how sure, or why none."""


def match_take(
    take: Take,
    reading: Reading,
    libraries: Sequence[Library],
    floor_m: float | None = None,
    keyframe_count: int | None = None,
) -> Job[LibraryChoice]:
    """Find postures of a library in a take's footage.

    Args:
        take: The take; its keyframes are not used.
        reading: What `read_footage` has read of its clip.
        libraries: One library, which is matched however badly it fits, or several, of which the one that fits
            best is chosen.
        floor_m: Height of the floor in the world [m]; None where it is not known.
        keyframe_count: How many frames to be told the posture of; 10 per 100 frames where None.

    Yields:
        Progress.

    Raises:
        InputError: There is no library, none has a posture, or no marker is seen in the footage.
    """
    usable = [library for library in libraries if library.postures]
    if not usable:
        raise InputError("no keyframe library with a posture is given; at least one is needed to match with")
    tracks = reading.tracks
    if not tracks.visible.any():
        raise InputError(f"{take.folder}: no marker is seen in the footage, so no posture can be matched")
    keyframes = propose_keyframes(marker_speed(tracks), keyframe_count)
    sought = Sought(take.body, take.camera, tracks, take.marker_segments, keyframes)
    matches = []
    with threadpool_limits(limits=1, user_api="blas"):
        for index, library in enumerate(usable):
            part = match_library(sought, library, floor_m)
            stage = f"Matching {library.title}"
            found = yield from within(stage, part, index / len(usable), (index + 1) / len(usable))
            matches.append(found)
    yield Progress("Done", 1.0)
    return _choice(matches)


def with_matches(take: Take, match: LibraryMatch) -> Take:
    """The take with a match's keyframes: posed ones stay, matched ones come where no posed one is near."""
    posed = [keyframe for keyframe in take.keyframes if keyframe.matched is None]
    keyframes = list(posed)
    for frame in match.frames:
        if any(abs(keyframe.index - frame.index) <= NEAR_FRAMES for keyframe in posed):
            continue
        chosen = frame.candidates[0]
        said = Matched(match.library.identifier, chosen.name, chosen.mirrored, chosen.confidence)
        keyframes.append(Keyframe(frame.index, chosen.posture, matched=said))
    return replace(take, keyframes=tuple(sorted(keyframes, key=lambda keyframe: keyframe.index)))


def _choice(matches: Sequence[LibraryMatch]) -> LibraryChoice:
    evidence = np.array([match.log_evidence for match in matches])
    share = np.exp(evidence - evidence.max())
    share /= share.sum()
    order = np.argsort(-share, kind="stable")
    ranking = tuple((matches[int(i)].library, float(share[i])) for i in order)
    best = matches[int(order[0])]
    if len(matches) == 1:
        return LibraryChoice(ranking, best, f"{best.library.title} explains the footage to {best.fit:.0%}")
    if best.fit < LEAST_FIT:
        reason = (
            f"none of the {len(matches)} libraries fits: {best.library.title}, the nearest, "
            f"explains the footage to {best.fit:.0%} only"
        )
        return LibraryChoice(ranking, None, reason)
    reason = f"{best.library.title}, {share[order[0]]:.0%} sure; it explains the footage to {best.fit:.0%}"
    return LibraryChoice(ranking, best, reason)
