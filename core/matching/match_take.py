"""From a take and libraries to the postures its footage shows: what command line and Blender share."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from ..errors import InputError
from ..files.digest import digest
from ..footage.reading import Reading
from ..library.library import Library
from ..prior.keyframe_proposals import propose_keyframes
from ..prior.keyframes import Keyframe, Matched
from ..prior.marker_speed import marker_speed
from ..progress import Job, Progress, stretch, within
from ..take.description import Description
from ..take.read_footage import read_footage
from ..take.take import Take, read_described
from .library_match import LibraryMatch, Prepared, Sought, match_library, prepare, prepared_anew
from .posed_constraints import Anchors

TRIED = 5
"""So many libraries at most are matched as a whole where the first look leaves several."""
HOPELESS = 4.0
"""How much dearer than the best a library's postures may be in the first look, a frame."""
NONE_EVIDENCE = -11.0
"""Logarithm of the evidence of an independent frame for footage that no library was made for."""
FRAMES_TOLD = 1.6
"""A performer differs from a library all along a clip, which tells as much as so many independent frames."""
LOOKING = 0.3
"""Share of the work that the first look is."""
AGAIN = 0.7
"""Share that the first round is, where the footage is then read again."""
OTHER_REGION, OFTEN = 1.0, 0.15
"""Another region lies this far off, in sizes; a marker that was another thing is so in so many frames."""
WELL = 0.9
"""Where so much of the footage is explained, no marker is another thing."""
BETTER = 0.04
"""So much more of the footage is explained where what was read again is right."""
NEAR_FRAMES = 2
"""No matched keyframe comes so near to a posed one."""


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
    reading: Reading | None = None
    """The clip as it was read again with the match to tell where each marker is; None where that changed
    nothing, and what was given holds."""


def take_to_match(description: Description, keyframes: Path | None) -> Take:
    """Read a take with the keyframes that a person posed; without a file named, with none.

    What an earlier run has matched in that file is left out, since it is matched anew.

    Raises:
        InputError: The take or the keyframe file is unusable.
    """
    fewest = 0 if keyframes is None else 1
    take = read_described(description, keyframes, keyframes_required=False, fewest_keyframes=fewest)
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
        reading: What `read_footage` has read of its clip.
        libraries: One library, which is matched however badly it fits, or several, of which the one that fits
            best is chosen.
        floor_m: Height of the floor in the world [m]; None where it is not known.
        keyframe_count: How many frames to be told the posture of; 10 per 100 frames where None.

    Yields:
        Progress.

    Returns:
        The choice. Where the first match shows that another thing of its color was taken for a marker, the
        clip is read again (from what was seen, see `read_footage`) and matched once more.

    Raises:
        InputError: There is no library, none has a posture, or no marker is seen in the footage.
    """
    usable = [library for library in libraries if library.postures]
    if not usable:
        raise InputError("no keyframe library with a posture is given; at least one is needed to match with")
    if not reading.tracks.visible.any():
        raise InputError(f"{take.clip}: no marker is seen in the footage, so no posture can be matched")
    with threadpool_limits(limits=1, user_api="blas"):
        sought = _sought(take, reading, keyframe_count)
        prepared = yield from stretch(_prepared(sought, usable), 0.0, LOOKING * AGAIN)
        first = _matches(sought, prepared, floor_m)
        matches = yield from stretch(first, LOOKING * AGAIN, AGAIN)
        choice = _choice(usable, matches)
        better = yield from stretch(_read_again(take, reading, matches[0]), AGAIN, AGAIN)
        if better is not None:
            sought = _sought(take, better, keyframe_count)
            found = [match.library for match in matches]
            anew = [prepared_anew(sought, one) for one in prepared if one.library in found]
            second = _matches(sought, anew, floor_m)
            again = yield from stretch(second, AGAIN, 1.0)
            if again[0].fit > matches[0].fit + BETTER:
                choice = replace(_choice(usable, again), reading=better)
    yield Progress("Done", 1.0)
    return choice


def _sought(take: Take, reading: Reading, keyframe_count: int | None) -> Sought:
    keyframes = propose_keyframes(marker_speed(reading.tracks), keyframe_count)
    anchors = Anchors.of(take.body, take.keyframes)
    return Sought(take.body, take.camera, reading.tracks, take.marker_segments, keyframes, anchors)


def _prepared(sought: Sought, libraries: Sequence[Library]) -> Job[list[Prepared]]:
    """All libraries on the performer's body, each with a first look."""
    prepared = []
    for index, library in enumerate(libraries):
        yield Progress(f"Looking for {library.title}", index / len(libraries))
        prepared.append(prepare(sought, library))
    return prepared


def _matches(sought: Sought, prepared: Sequence[Prepared], floor_m: float | None) -> Job[list[LibraryMatch]]:
    """The matches of the libraries that are worth it, the likeliest first."""
    tried = _worth_trying(prepared)
    if floor_m is None:
        floor_m = sought.anchors.floor_m()
    # A floor at z = 0 is believed in as long as any likely library may stand on it.
    floor = min((one.glance.floor_m for one in tried), key=abs) if floor_m is None else floor_m
    matches = []
    for index, one in enumerate(tried):
        share = [(index + end) / len(tried) for end in (0, 1)]
        part = match_library(sought, one, floor)
        matches.append((yield from within(f"Matching {one.library.title}", part, *share)))
    return sorted(matches, key=lambda match: -match.log_evidence)


def _read_again(take: Take, reading: Reading, match: LibraryMatch) -> Job[Reading | None]:
    """The clip read once more, each marker sought where a match has it; None where that makes no difference.

    Without keyframes a thing of a marker's color may have been taken for it. A marker that is merely lost
    where the match has it stays what it was: an arm may do something that the library does not.
    """
    if reading.detections is None or match.fit > WELL:
        return None
    told = with_matches(replace(take, keyframes=()), match)
    again = yield from read_footage(told, reading)
    first, second = reading.tracks, again.tracks
    apart = np.linalg.norm(first.centroid - second.centroid, axis=-1)  # NaN where hidden in either
    elsewhere = (apart > OTHER_REGION * np.sqrt(np.nan_to_num(second.area))).mean(axis=0) > OFTEN
    if not elsewhere.any():
        return None
    names = ("centroid", "second_moment", "area", "quality", "clipped")
    arrays: dict[str, Any] = {name: np.array(getattr(first, name)) for name in names}
    for name, array in arrays.items():
        array[:, elsewhere] = getattr(second, name)[:, elsewhere]
    # Known again by both readings that it is made of.
    footage = again.key.rpartition("-")[0]
    key = f"{footage}-{digest(reading.key, again.key, elsewhere)}" if footage else ""
    return replace(again, tracks=replace(first, **arrays), key=key)


def _worth_trying(prepared: Sequence[Prepared]) -> list[Prepared]:
    """The libraries whose postures do about as well as the best in the first look."""
    ranked = sorted(prepared, key=lambda one: one.glance.cost)
    least = ranked[0].glance.cost
    return [one for one in ranked[:TRIED] if one.glance.cost - least < HOPELESS]


def with_matches(take: Take, match: LibraryMatch) -> Take:
    """The take with a match's keyframes: posed ones stay, and matched ones near them move beside them.

    Beside a posed keyframe a matched one tells how the performer differs from the library
    (`prior/performer_offset`).
    """
    posed = [keyframe.index for keyframe in take.keyframes if keyframe.matched is None]
    keyframes = {keyframe.index: keyframe for keyframe in take.keyframes if keyframe.matched is None}
    for frame in match.frames:
        index = _beside(frame.index, posed, match.course.batch[0])
        if index is None or index in keyframes:
            continue
        chosen = frame.candidates[0]
        posture = chosen.posture if index == frame.index else match.course[index]
        said = Matched(match.library.identifier, chosen.name, chosen.mirrored, chosen.confidence)
        keyframes[index] = Keyframe(index, posture, matched=said)
    return replace(take, keyframes=tuple(keyframes[index] for index in sorted(keyframes)))


def _beside(index: int, posed: Sequence[int], frames: int) -> int | None:
    """The frame itself or, near a posed keyframe, the nearest that is not; None where there is none."""
    reach = range(-NEAR_FRAMES - 1, NEAR_FRAMES + 2)
    free = [
        index + step
        for step in sorted(reach, key=abs)
        if 0 <= index + step < frames and all(abs(index + step - other) > NEAR_FRAMES for other in posed)
    ]
    return free[0] if free else None


def _choice(libraries: Sequence[Library], ranked: Sequence[LibraryMatch]) -> LibraryChoice:
    best = ranked[0]
    title, explained = best.library.title, f"{best.fit:.0%}"
    if len(libraries) == 1:
        return LibraryChoice(((best.library, 1.0),), best, f"{title} explains {explained} of the footage")
    evidence = np.array([*(match.log_evidence for match in ranked), NONE_EVIDENCE])
    share = np.exp(FRAMES_TOLD * (evidence - evidence.max()))
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
