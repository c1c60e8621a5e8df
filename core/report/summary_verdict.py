"""What a person has to do about a take of a batch, and in which order takes ask for it."""

from collections.abc import Sequence
from enum import StrEnum

from ..estimate.weak_frames import WEAK_CONFIDENCE
from ..shoot.outcome import Outcome, Status

GOOD = WEAK_CONFIDENCE
"""Mean confidence from which a take is good: frames believed as far need no keyframe."""
FAIR = 0.5
"""Mean confidence from which a take is fair: below, most joints are rather not in place."""
GOOD_WEAKEST = FAIR
"""What the weakest twentieth of a good take's frames is believed at least."""


class Verdict(StrEnum):
    """How a take stands, those first that need a person first."""

    FAILED = "failed"
    POOR = "poor"
    FAIR = "fair"
    UNJUDGED = "not judged"
    """Converted by a method that does not know how sure it is."""
    GOOD = "good"
    WAITING = "waiting"


def verdict(outcome: Outcome) -> Verdict:
    """How a take stands."""
    if outcome.status is Status.FAILED:
        return Verdict.FAILED
    if outcome.status is Status.WAITING or outcome.record is None:
        return Verdict.WAITING
    return judged(outcome.record.confidence, outcome.record.weakest)


def judged(confidence: float | None, weakest: float | None) -> Verdict:
    """Good, fair or poor, by the mean confidence of the frames and that of the weakest twentieth."""
    if confidence is None:
        return Verdict.UNJUDGED
    if confidence >= GOOD and (weakest is None or weakest >= GOOD_WEAKEST):
        return Verdict.GOOD
    return Verdict.FAIR if confidence >= FAIR else Verdict.POOR


def sections(outcomes: Sequence[Outcome]) -> dict[Verdict, list[Outcome]]:
    """All takes by verdict, verdicts without any left out; those of least confidence first, then by name."""
    found: dict[Verdict, list[Outcome]] = {kind: [] for kind in Verdict}
    for outcome in sorted(outcomes, key=_urgency):
        found[verdict(outcome)].append(outcome)
    return {kind: those for kind, those in found.items() if those}


def _urgency(outcome: Outcome) -> tuple[float, str]:
    converted = outcome.status in (Status.CONVERTED, Status.UNCHANGED)
    believed = outcome.record.confidence if converted and outcome.record is not None else None
    return (0.0 if believed is None else believed, outcome.take)
