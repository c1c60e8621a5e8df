"""The head of a batch's page: how many, and what deserves attention first."""

from collections import Counter
from collections.abc import Mapping, Sequence

from ...shoot.outcomes.outcome import Outcome, Status
from ...text import pluralize
from .html_text import duration, isolated, percent
from .verdict import Verdict, result

NAMED = 3
"""So many takes are named in a sentence."""


def counts(outcomes: Sequence[Outcome]) -> str:
    """The numbers of takes by status, and how much footage has been converted."""
    number = {status: sum(outcome.status is status for outcome in outcomes) for status in Status}
    done = [record for record in map(result, outcomes) if record is not None]
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
        said.append(f"{pluralize(len(failed), 'take')} failed: {_named(failed, number)}.{_shared(failed)}")
    if poor:
        said.append(f"{_are(poor, 'poor, in need of keyframes')}: {_named(poor, number)}.")
    if fair:
        said.append(f"{_are(fair, 'fair, worth a look')}: {_named(fair, number)}.")
    if waiting:
        said.append(
            f"{_are(waiting, 'still to be converted')}: the batch was running when this was written, or was "
            "interrupted; run it again and it goes on from here."
        )
    if not said:
        said.append("Nothing failed and nothing is in doubt." if found else "There are no takes.")
    return f'<ul class="first">{"".join(f"<li>{sentence}</li>" for sentence in said)}</ul>'


def _are(outcomes: Sequence[Outcome], what: str) -> str:
    return f"{pluralize(len(outcomes), 'take')} {'is' if len(outcomes) == 1 else 'are'} {what}"


def _named(outcomes: Sequence[Outcome], number: Mapping[str, int]) -> str:
    names = [
        f'<a href="#take-{number[outcome.take]}">{isolated(outcome.take)}</a>{_share(outcome)}'
        for outcome in outcomes[:NAMED]
    ]
    more = len(outcomes) - NAMED
    return ", ".join(names) + (f" and {more} more" if more > 0 else "")


def _shared(failed: Sequence[Outcome]) -> str:
    """The sentence that several takes failed with: one mistake in a shoot fails all its takes."""
    sentence, count = Counter(outcome.error or "" for outcome in failed).most_common(1)[0]
    if count == 1 or not sentence:
        return ""
    return f" {'All' if count == len(failed) else count} for one reason: {isolated(sentence)}."


def _share(outcome: Outcome) -> str:
    record = result(outcome)
    if record is None or record.confidence is None:
        return ""
    return f" ({percent(record.confidence)})"
