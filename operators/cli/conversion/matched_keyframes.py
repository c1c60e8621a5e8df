"""Converting a take with a keyframe library in place of posed keyframes, or beside them."""

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

NAMED = 3
"""So many libraries are named where none fits."""
SHARES_WITH_ONE, SHARES_WITH_MORE = (0.3, 0.5), (0.1, 0.8)
"""How far the whole job is when the footage is read, and when it is matched with one library or several."""


@dataclass(frozen=True, eq=False)
class Solved:
    """A motion and what it was reconstructed from."""

    take: Take
    """With its matched keyframes, where there are some."""
    reconstruction: Reconstruction
    choice: LibraryChoice | None = None
    """Which library was matched; None where none was asked for, or none fits."""
    unfit: tuple[str, ...] = ()
    """A sentence where no library fits and the posed keyframes count alone."""


def solve(take: Take, libraries: Sequence[Library], method: str, floor_m: float | None = None) -> Job[Solved]:
    """Reconstruct a motion, after matching its footage where there are libraries; the footage is read once.

    Args:
        take: The take, with posed keyframes or, where it is matched, without.
        libraries: None; or one, which is taken however badly it fits; or several to choose from.
        method: As for `reconstruct`.
        floor_m: Height of the floor where it is known [m].

    Raises:
        InputError: The clip cannot be used.
        ConversionError: No library fits the footage of a take that is not posed, or no motion could be
            computed.
    """
    if not libraries:
        return Solved(take, (yield from reconstruct(take, method)))
    read, matched = SHARES_WITH_ONE if len(libraries) == 1 else SHARES_WITH_MORE
    reading = yield from stretch(read_footage(take), 0.0, read)
    choice = yield from stretch(match_take(take, reading, libraries, floor_m), read, matched)
    if choice.match is None:
        if len(take.keyframes) < FEWEST_KEYFRAMES:
            likely = ", ".join(f"{library.title} {share:.0%}" for library, share in choice.ranking[:NAMED])
            said = f"{take.clip}: {choice.reason}; likeliest are {likely}; nothing was written"
            raise ConversionError(said)
        result = yield from stretch(reconstruct(take, method, reading), matched, 1.0)
        return Solved(take, result, unfit=(f"{choice.reason}; only the posed keyframes count",))
    take = with_matches(take, choice.match)
    solving = reconstruct(take, method, choice.reading or reading)
    return Solved(take, (yield from stretch(solving, matched, 1.0)), choice)


def match_summary(take: Take, choice: LibraryChoice) -> dict[str, Any]:
    """What was matched, for `--json`."""
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
