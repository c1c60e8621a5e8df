"""Matching a take with libraries: the postures its footage shows, shared by command line and Blender."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from ..errors import InputError
from ..footage.keypoints.keypoints import Keypoints
from ..footage.reading import Reading
from ..library.library import Library
from ..prior.evidence_speed import evidence_speed
from ..prior.keyframe_proposals import propose_keyframes
from ..progress import Job, Progress, run, stretch, within
from ..take.conversion_settings import ConversionSettings
from ..take.description import Description
from ..take.performer_keypoints import performer_keypoints
from ..take.take import Take
from ..take.take_file import read_described
from .library_match import (
    LibraryMatch,
    MatchInput,
    PreparedLibrary,
    match_library,
    prepare_library,
    repeat_coarse_pass,
)
from .match_evidence import MatchEvidence
from .matched_keyframes import with_matched
from .posed_constraints import PosedConstraints
from .second_reading import BETTER_BY, second_reading

MOST_TRIED = 5
"""Libraries matched in full at most, where the coarse pass leaves several."""
COARSE_COST_MARGIN = 4.0
"""A library whose mean cost in the coarse pass exceeds the least by more is not matched in full."""
NONE_EVIDENCE = -11.0
"""Log evidence of an independent frame of footage that no library was made for."""
INDEPENDENT_FRAMES = 1.6
"""Independent frames that a whole clip counts for, since a performer differs from a library all along it."""
COARSE_SHARE = 0.3
"""Share of the work that the coarse pass is."""
FIRST_ROUND_SHARE = 0.7
"""Share of the first round, where the footage is then read again."""


@dataclass(frozen=True, eq=False)
class LibraryChoice:
    """The library that fits footage best, and the probabilities of all."""

    ranking: tuple[tuple[Library, float], ...]
    """Every library with its probability, the likeliest first; what is missing to 1 is the probability of
    none."""
    match: LibraryMatch | None
    """The likeliest library's match; None where none fits."""
    reason: str
    """Sentence for people: which library, how sure, or why none."""
    reading: Reading | None = None
    """The clip as read again with the match telling where each marker is; None where the given reading
    holds."""


def take_to_match(
    description: Description, keyframes: Path | None, settings: ConversionSettings | None = None
) -> Take:
    """Read a take with the keyframes that a person posed, or with none where no file is named.

    Keyframes that an earlier run has matched are left out, since they are matched anew. `settings` say which
    keypoints are read and which evidence is used, by default the take's own.

    Raises:
        InputError: The take or the keyframe file is unusable.
    """
    fewest = 0 if keyframes is None else 1
    take = read_described(
        description, keyframes, keyframes_required=False, fewest_keyframes=fewest, settings=settings
    )
    return replace(take, keyframes=tuple(k for k in take.keyframes if k.matched is None))


def match_take(
    take: Take,
    reading: Reading,
    libraries: Sequence[Library],
    floor_m: float | None = None,
    keyframe_count: int | None = None,
) -> Job[LibraryChoice]:
    """Find postures of a library in a take's footage.

    Args:
        take: The take; posed keyframes tell where the performer is there, matched ones are not used.
        reading: The clip as `read_footage` has read it.
        libraries: One library, which is matched even where it fits badly, or several, of which the one that
            fits best is chosen.
        floor_m: Height of the floor in the world [m]; None where it is not known.
        keyframe_count: Number of frames to match keyframes at; 10 per 100 frames where None.

    Yields:
        Progress.

    Returns:
        The choice. Where the first match shows that another thing of its color was taken for a marker, the
        clip is read again (from what was seen, see `read_footage`) and matched once more.

    Raises:
        InputError: There is no library, none has a posture, or neither a marker nor a keypoint is seen.
    """
    usable = [library for library in libraries if library.postures]
    if not usable:
        raise InputError("no keyframe library with a posture is given; at least one is needed to match with")
    keypoints = performer_keypoints(take, None, reading.tracks)
    if not (reading.tracks.visible.any() or keypoints.seen.any()):
        raise InputError(nothing_seen(take))
    with threadpool_limits(limits=1, user_api="blas"):
        match_input = read_match_input(take, reading, keypoints, keyframe_count)
        prepared = yield from stretch(_prepared(match_input, usable), 0.0, COARSE_SHARE * FIRST_ROUND_SHARE)
        first = _matches(match_input, prepared, floor_m)
        matches = yield from stretch(first, COARSE_SHARE * FIRST_ROUND_SHARE, FIRST_ROUND_SHARE)
        choice = _choice(usable, matches)
        unposed = with_matches(replace(take, keyframes=()), matches[0])
        again_read = second_reading(unposed, reading, matches[0].fit)
        better = yield from stretch(again_read, FIRST_ROUND_SHARE, FIRST_ROUND_SHARE)
        if better is not None:
            match_input = read_match_input(take, better, keypoints, keyframe_count)
            found = [match.library for match in matches]
            repeated = [repeat_coarse_pass(match_input, one) for one in prepared if one.library in found]
            second = _matches(match_input, repeated, floor_m)
            again = yield from stretch(second, FIRST_ROUND_SHARE, 1.0)
            if again[0].fit > matches[0].fit + BETTER_BY:
                choice = replace(_choice(usable, again), reading=better)
    yield Progress("Done", 1.0)
    return choice


def nothing_seen(take: Take) -> str:
    """What a library cannot be matched for the lack of."""
    if take.markers or take.keypoints:
        missing = " and ".join(
            name for name, has in (("marker", take.markers), ("keypoint", take.keypoints)) if has
        )
        return f"{take.clip}: no {missing} is seen in the footage, so no posture can be matched"
    return (
        f"{take.file}: the take has neither markers nor keypoints, without which no posture of a library can "
        "be found; give it one of them, or pose its keyframes"
    )


def read_match_input(
    take: Take, reading: Reading, keypoints: Keypoints, keyframe_count: int | None
) -> MatchInput:
    """What a match needs of a take, with the frames proposed for keyframes."""
    # Pictures are not asked: something is seen.
    speed = run(evidence_speed(reading.tracks, take.marker_segments, keypoints))
    keyframes = propose_keyframes(speed.values, keyframe_count)
    constraints = PosedConstraints.from_keyframes(take.body, take.keyframes)
    evidence = MatchEvidence.of(reading.tracks, take.marker_segments, keypoints)
    return MatchInput(take.body, take.camera, evidence, keyframes, constraints)


def _prepared(match_input: MatchInput, libraries: Sequence[Library]) -> Job[list[PreparedLibrary]]:
    """All libraries on the performer's body, after the coarse pass."""
    prepared = []
    for index, library in enumerate(libraries):
        yield Progress(f"Looking for {library.title}", index / len(libraries))
        prepared.append(prepare_library(match_input, library))
    return prepared


def _matches(
    match_input: MatchInput, prepared: Sequence[PreparedLibrary], floor_m: float | None
) -> Job[list[LibraryMatch]]:
    """Matches of the likely libraries, the likeliest first."""
    tried = _likely_libraries(prepared)
    if floor_m is None:
        floor_m = match_input.constraints.floor_m()
    # A floor at z = 0 is believed in as long as any likely library may stand on it.
    floor = min((one.coarse_pass.floor_m for one in tried), key=abs) if floor_m is None else floor_m
    matches = []
    for index, one in enumerate(tried):
        share = [(index + end) / len(tried) for end in (0, 1)]
        part = match_library(match_input, one, floor)
        matches.append((yield from within(f"Matching {one.library.title}", part, *share)))
    return sorted(matches, key=lambda match: -match.log_evidence)


def _likely_libraries(prepared: Sequence[PreparedLibrary]) -> list[PreparedLibrary]:
    """Libraries whose postures fit about as well as the best ones in the coarse pass."""
    ranked = sorted(prepared, key=lambda one: one.coarse_pass.cost)
    least = ranked[0].coarse_pass.cost
    return [one for one in ranked[:MOST_TRIED] if one.coarse_pass.cost - least < COARSE_COST_MARGIN]


def with_matches(take: Take, match: LibraryMatch) -> Take:
    """The take with a match's keyframes, see `with_matched`."""
    return with_matched(take, match.frames, match.postures, match.library.identifier)


def _choice(libraries: Sequence[Library], ranked: Sequence[LibraryMatch]) -> LibraryChoice:
    best = ranked[0]
    title, explained = best.library.title, f"{best.fit:.0%}"
    if len(libraries) == 1:
        return LibraryChoice(((best.library, 1.0),), best, f"{title} explains {explained} of the footage")
    evidence = np.array([*(match.log_evidence for match in ranked), NONE_EVIDENCE])
    share = np.exp(INDEPENDENT_FRAMES * (evidence - evidence.max()))
    share /= share.sum()
    tried = [match.library for match in ranked]
    rest = [library for library in libraries if library not in tried]
    ranking = tuple(zip([*tried, *rest], [*map(float, share[:-1]), *[0.0] * len(rest)], strict=True))
    if share[-1] > share[0]:
        reason = (
            f"no library fits ({share[-1]:.0%} sure); {title}, the nearest, explains {explained} of the "
            "footage"
        )
        return LibraryChoice(ranking, None, reason)
    reason = f"{title} ({share[0]:.0%} sure); it explains {explained} of the footage"
    return LibraryChoice(ranking, best, reason)
