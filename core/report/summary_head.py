"""The head of a batch's page: how many, and what deserves attention first."""

from collections.abc import Mapping, Sequence

from ..shoot.outcome import Outcome, Status
from .summary_text import counted, duration, isolated, percent
from .summary_verdict import Verdict

NAMED = 3
"""So many takes are named in a sentence."""


def counts(outcomes: Sequence[Outcome]) -> str:
    """The numbers of takes by status, and how much footage has been converted."""
    number = {status: sum(outcome.status is status for outcome in outcomes) for status in Status}
    done = [
        outcome.record
        for outcome in outcomes
        if outcome.record is not None and outcome.status in (Status.CONVERTED, Status.UNCHANGED)
    ]
    figures = [("takes", len(outcomes)), *((status.value, number[status]) for status in Status)]
    figures.append(("frames", sum(record.frames for record in done)))
    length = duration(sum(record.frames / record.fps for record in done))
    items = [f"<div><dt>{name}</dt><dd>{count}</dd></div>" for name, count in figures]
    return f"<dl>{''.join(items)}<div><dt>footage</dt><dd>{length}</dd></div></dl>"


def first_things(found: Mapping[Verdict, Sequence[Outcome]], number: Mapping[str, int]) -> str:
    """What a supervisor should turn to first, in a sentence each.

    Args:
        found: Takes by verdict, in the order they need a person.
        number: What the anchor of each take is made of.
    """
    said = []
    failed, poor, fair, waiting = (
        found.get(verdict, ()) for verdict in (Verdict.FAILED, Verdict.POOR, Verdict.FAIR, Verdict.WAITING)
    )
    if failed:
        said.append(f"{counted(len(failed), 'take')} failed: {_named(failed, number)}.")
    if poor:
        said.append(f"{_are(poor, 'poor')} and want keyframes: {_named(poor, number)}.")
    if fair:
        said.append(f"{_are(fair, 'fair')} and worth a look: {_named(fair, number)}.")
    if waiting:
        said.append(
            f"{_are(waiting, 'still to be converted')}: the batch was running when this was written, or was "
            "interrupted; run it again and it goes on from here."
        )
    if not said:
        said.append("Nothing failed and nothing is in doubt." if found else "There are no takes.")
    return f'<ul class="first">{"".join(f"<li>{sentence}</li>" for sentence in said)}</ul>'


def _are(outcomes: Sequence[Outcome], what: str) -> str:
    return f"{counted(len(outcomes), 'take')} {'is' if len(outcomes) == 1 else 'are'} {what}"


def _named(outcomes: Sequence[Outcome], number: Mapping[str, int]) -> str:
    names = [
        f'<a href="#take-{number[outcome.take]}">{isolated(outcome.take)}</a>{_share(outcome)}'
        for outcome in outcomes[:NAMED]
    ]
    more = len(outcomes) - NAMED
    return ", ".join(names) + (f" and {more} more" if more > 0 else "")


def _share(outcome: Outcome) -> str:
    if outcome.status is Status.FAILED or outcome.record is None or outcome.record.confidence is None:
        return ""
    return f" ({percent(outcome.record.confidence)})"
