"""Verdicts on the takes of a batch: how much work each needs, and the order of urgency."""

from collections.abc import Sequence
from enum import StrEnum

from ...review.weak_frames import WEAK_CONFIDENCE
from ...shoot.outcomes import Outcome, Status
from ...take.conversion_record import ConversionRecord

GOOD = WEAK_CONFIDENCE
"""Mean confidence from which a take is good: frames of this confidence need no keyframe."""
FAIR = 0.5
"""Mean confidence from which a take is fair: below, most joints are likely off."""
GOOD_WEAKEST = FAIR
"""Least confidence of the weakest twentieth of a good take's frames."""


class Verdict(StrEnum):
    """State of a take, the most urgent first."""

    FAILED = "failed"
    POOR = "poor"
    FAIR = "fair"
    UNJUDGED = "not judged"
    """Converted by a method without a confidence."""
    GOOD = "good"
    WAITING = "waiting"


def current_record(outcome: Outcome) -> ConversionRecord | None:
    """The record of a take's result; None without a result of the present input."""
    return outcome.record if outcome.status in (Status.CONVERTED, Status.UNCHANGED) else None


def verdict(outcome: Outcome) -> Verdict:
    """The verdict on a take; of a result by its mean confidence and that of its weakest twentieth."""
    if outcome.status is Status.FAILED:
        return Verdict.FAILED
    record = current_record(outcome)
    if record is None:
        return Verdict.WAITING
    if record.confidence is None:
        return Verdict.UNJUDGED
    if record.confidence >= GOOD and (record.weakest is None or record.weakest >= GOOD_WEAKEST):
        return Verdict.GOOD
    return Verdict.FAIR if record.confidence >= FAIR else Verdict.POOR


def sections(outcomes: Sequence[Outcome]) -> dict[Verdict, list[Outcome]]:
    """Takes by verdict, without empty verdicts; sorted by confidence, the least first, then by name."""
    found: dict[Verdict, list[Outcome]] = {kind: [] for kind in Verdict}
    for outcome in sorted(outcomes, key=_urgency):
        found[verdict(outcome)].append(outcome)
    return {kind: those for kind, those in found.items() if those}


def _urgency(outcome: Outcome) -> tuple[float, str]:
    record = current_record(outcome)
    return (0.0 if record is None or record.confidence is None else record.confidence, outcome.take)
