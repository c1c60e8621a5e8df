"""What a person has to do about a take of a batch, and in which order takes ask for it."""

from collections.abc import Sequence
from enum import StrEnum

from ...review.weak_frames import WEAK_CONFIDENCE
from ...shoot.outcomes.outcome import Outcome, Status
from ...take.conversion_record import ConversionRecord

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


def result(outcome: Outcome) -> ConversionRecord | None:
    """What is recorded of a take's result; None where there is none, or only one of an earlier input."""
    return outcome.record if outcome.status in (Status.CONVERTED, Status.UNCHANGED) else None


def verdict(outcome: Outcome) -> Verdict:
    """How a take stands: if it has a result, by the confidence of its frames and of the weakest twentieth."""
    if outcome.status is Status.FAILED:
        return Verdict.FAILED
    record = result(outcome)
    if record is None:
        return Verdict.WAITING
    if record.confidence is None:
        return Verdict.UNJUDGED
    if record.confidence >= GOOD and (record.weakest is None or record.weakest >= GOOD_WEAKEST):
        return Verdict.GOOD
    return Verdict.FAIR if record.confidence >= FAIR else Verdict.POOR


def sections(outcomes: Sequence[Outcome]) -> dict[Verdict, list[Outcome]]:
    """All takes by verdict, verdicts without any left out; those of least confidence first, then by name."""
    found: dict[Verdict, list[Outcome]] = {kind: [] for kind in Verdict}
    for outcome in sorted(outcomes, key=_urgency):
        found[verdict(outcome)].append(outcome)
    return {kind: those for kind, those in found.items() if those}


def _urgency(outcome: Outcome) -> tuple[float, str]:
    record = result(outcome)
    return (0.0 if record is None or record.confidence is None else record.confidence, outcome.take)
