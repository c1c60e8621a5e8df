"""Matching a clip with one library: the postures of it that the footage shows."""

from dataclasses import replace

from threadpoolctl import threadpool_limits

from ..errors import InputError
from ..footage.reading import Reading
from ..library.library import Library
from ..matching.library_match import LibraryMatch, PreparedLibrary, match_library, prepare_library
from ..matching.match_input import MatchInput, match_input
from ..progress import Job, Progress, stretch, within
from ..take.take import Take
from ..text import Sentence
from .found_poses import FoundPoses
from .second_reading import is_better, read_again

PREPARED_SHARE, FIRST_ROUND_SHARE = 0.2, 0.7
"""Shares of the work after which the library is on the performer's body, and where the footage is read
again."""


def match_clip(
    take: Take,
    reading: Reading,
    library: Library,
    floor_m: float | None = None,
    keyframe_count: int | None = None,
) -> Job[FoundPoses]:
    """Find postures of a library in a take's footage, however badly it fits.

    Args:
        take: The take; posed keyframes tell where the performer is there, found ones are not used.
        reading: The clip as `read_footage` has read it.
        library: The library.
        floor_m: Height of the floor in the world [m]; None where it is not known.
        keyframe_count: Number of frames to find keyframes at; 10 per 100 frames where None.

    Yields:
        Progress.

    Returns:
        The postures. Where the first match shows that another thing of its color was taken for a marker, the
        clip is read again (from what was seen, see `read_footage`) and matched once more.

    Raises:
        InputError: The library has no posture, or neither a marker nor a keypoint is seen.
    """
    if not library.postures:
        raise InputError(f"the library {library.title} has no posture; at least one is needed to match with")
    with threadpool_limits(limits=1, user_api="blas"):
        given = match_input(take, reading, keyframe_count)
        yield Progress(Sentence("Looking for {library}", library=library.title), 0.0)
        prepared = prepare_library(given, library)
        found = yield from _found(given, prepared, floor_m, PREPARED_SHARE, FIRST_ROUND_SHARE)
        reading_again = read_again(take, reading, found)
        better = yield from stretch(reading_again, FIRST_ROUND_SHARE, FIRST_ROUND_SHARE)
        if better is not None:
            given = match_input(take, better, keyframe_count)
            again = yield from _found(given, prepared, floor_m, FIRST_ROUND_SHARE, 1.0)
            found = replace(again, reading=better) if is_better(again, found) else found
    yield Progress(Sentence("Matching {library}", library=library.title), 1.0)
    return found


def _found(
    given: MatchInput, prepared: PreparedLibrary, floor_m: float | None, begun: float, done: float
) -> Job[FoundPoses]:
    """The match of a library that is prepared."""
    job = match_library(given, prepared, floor_m)
    match: LibraryMatch = yield from within(
        Sentence("Matching {library}", library=prepared.library.title), job, begun, done
    )
    reason = Sentence(
        "{library} explains {fit:.0%} of the footage", library=match.library.title, fit=match.fit
    )
    return FoundPoses(
        match.frames, match.postures, match.fit, match.floor_m, reason, library=match.library.identifier
    )
