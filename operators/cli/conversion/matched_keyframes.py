"""Reconstruction of a take whose keyframes are posed, matched with a keyframe library, or both."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ....core.errors import ConversionError
from ....core.estimate.reconstruct import Reconstruction, reconstruct
from ....core.library.library import Library
from ....core.matching.match_take import LibraryChoice, match_take, with_matches
from ....core.progress import Job, stretch
from ....core.take.keyframe_file import FEWEST_KEYFRAMES
from ....core.take.read_footage import read_footage
from ....core.take.take import Take

MOST_NAMED = 3
"""Libraries named in the sentence that none fits."""
PROGRESS_WITH_ONE, PROGRESS_WITH_SEVERAL = (0.3, 0.5), (0.1, 0.8)
"""Fractions of the whole job after reading the footage and after matching it, by the number of libraries."""


@dataclass(frozen=True, eq=False)
class MatchedReconstruction:
    """A motion, and the keyframes it was reconstructed from."""

    take: Take
    """With its matched keyframes, if any."""
    reconstruction: Reconstruction
    choice: LibraryChoice | None = None
    """The library that was matched; None where none was asked for, or none fits."""
    mismatch_notes: tuple[str, ...] = ()
    """A sentence where no library fits and only the posed keyframes count."""


def reconstruct_or_match(
    take: Take, libraries: Sequence[Library], method: str, floor_m: float | None = None
) -> Job[MatchedReconstruction]:
    """Reconstruct a motion, after matching the footage where libraries are given; the footage is read once.

    Args:
        take: The take, with posed keyframes or, where it is matched, without.
        libraries: None; or one, which is used however badly it fits; or several to choose from.
        method: As for `reconstruct`.
        floor_m: Height of the floor where it is known [m].

    Raises:
        InputError: The clip cannot be used.
        ConversionError: No library fits the footage of a take without posed keyframes, or no motion could be
            computed.
    """
    if not libraries:
        return MatchedReconstruction(take, (yield from reconstruct(take, method)))
    read, matched = PROGRESS_WITH_ONE if len(libraries) == 1 else PROGRESS_WITH_SEVERAL
    reading = yield from stretch(read_footage(take), 0.0, read)
    choice = yield from stretch(match_take(take, reading, libraries, floor_m), read, matched)
    if choice.match is None:
        if len(take.keyframes) < FEWEST_KEYFRAMES:
            likely = ", ".join(
                f"{library.title} {share:.0%}" for library, share in choice.ranking[:MOST_NAMED]
            )
            sentence = f"{take.clip}: {choice.reason}; likeliest are {likely}; nothing was written"
            raise ConversionError(sentence)
        result = yield from stretch(reconstruct(take, method, reading), matched, 1.0)
        return MatchedReconstruction(
            take, result, mismatch_notes=(f"{choice.reason}; only the posed keyframes count",)
        )
    take = with_matches(take, choice.match)
    job = reconstruct(take, method, choice.reading or reading)
    return MatchedReconstruction(take, (yield from stretch(job, matched, 1.0)), choice)


def match_summary(take: Take, choice: LibraryChoice) -> dict[str, Any]:
    """The match as an object for `--json`."""
    assert choice.match is not None
    probability = {library.identifier: value for library, value in choice.ranking}
    identifier = choice.match.library.identifier
    return {
        "library": identifier,
        "probability": _rounded(probability[identifier]),
        "ranking": [
            {"library": library.identifier, "title": library.title, "probability": _rounded(value)}
            for library, value in choice.ranking
        ],
        "fit": _rounded(choice.match.fit),
        "reason": choice.reason,
        "floor_m": choice.match.floor_m,
        "matches": [
            {
                "frame": keyframe.index + take.frame_start,
                "posture": keyframe.matched.posture,
                "mirrored": keyframe.matched.mirrored,
                "confidence": _rounded(keyframe.matched.confidence),
            }
            for keyframe in take.keyframes
            if keyframe.matched is not None
        ],
    }


def _rounded(value: float) -> float:
    return round(float(value), 4)
