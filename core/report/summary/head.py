"""The head of a batch's page: the counts of takes, and the takes that need work first."""

from collections import Counter
from collections.abc import Mapping, Sequence

from ...shoot.outcomes import Outcome, Status
from ...text import pluralize
from .html_text import duration, isolated, percent
from .verdict import Verdict, current_record

MOST_NAMED = 3
"""Takes named in a sentence."""


def counts(outcomes: Sequence[Outcome]) -> str:
    """The numbers of takes by status, and the amount of footage converted."""
    number = {status: sum(outcome.status is status for outcome in outcomes) for status in Status}
    done = [record for record in map(current_record, outcomes) if record is not None]
    figures = [("takes", len(outcomes)), *((status.value, number[status]) for status in Status)]
    figures.append(("frames", sum(record.frames for record in done)))
    length = duration(sum(record.frames / record.fps for record in done))
    items = [f"<div><dt>{name}</dt><dd>{count}</dd></div>" for name, count in figures]
    return f"<dl>{''.join(items)}<div><dt>footage</dt><dd>{length}</dd></div></dl>"


def urgent_items(found: Mapping[Verdict, Sequence[Outcome]], number: Mapping[str, int]) -> str:
    """The takes that a supervisor should turn to first, a sentence for each kind.

    Args:
        found: Takes by verdict, the most urgent verdict first.
        number: Number of each take in its anchor.
    """
    sentences = []
    failed, poor, fair, waiting = (
        found.get(verdict, ()) for verdict in (Verdict.FAILED, Verdict.POOR, Verdict.FAIR, Verdict.WAITING)
    )
    if failed:
        sentences.append(
            f"{pluralize(len(failed), 'take')} failed: {_take_links(failed, number)}.{_shared_reason(failed)}"
        )
    if poor:
        sentences.append(f"{_takes_are(poor, 'poor, in need of keyframes')}: {_take_links(poor, number)}.")
    if fair:
        sentences.append(f"{_takes_are(fair, 'fair, worth a look')}: {_take_links(fair, number)}.")
    if waiting:
        sentences.append(
            f"{_takes_are(waiting, 'still to be converted')}: the batch was running when this was written, "
            "or was interrupted; run it again and it goes on from here."
        )
    if not sentences:
        sentences.append("Nothing failed and nothing is in doubt." if found else "There are no takes.")
    return f'<ul class="first">{"".join(f"<li>{sentence}</li>" for sentence in sentences)}</ul>'


def _takes_are(outcomes: Sequence[Outcome], what: str) -> str:
    return f"{pluralize(len(outcomes), 'take')} {'is' if len(outcomes) == 1 else 'are'} {what}"


def _take_links(outcomes: Sequence[Outcome], number: Mapping[str, int]) -> str:
    names = [
        f'<a href="#take-{number[outcome.take]}">{isolated(outcome.take)}</a>{_confidence(outcome)}'
        for outcome in outcomes[:MOST_NAMED]
    ]
    more = len(outcomes) - MOST_NAMED
    return ", ".join(names) + (f" and {more} more" if more > 0 else "")


def _shared_reason(failed: Sequence[Outcome]) -> str:
    """The most common reason, where several takes share it: one error in a shoot fails all its takes."""
    sentence, count = Counter(outcome.error or "" for outcome in failed).most_common(1)[0]
    if count == 1 or not sentence:
        return ""
    return f" {'All' if count == len(failed) else count} for one reason: {isolated(sentence)}."


def _confidence(outcome: Outcome) -> str:
    record = current_record(outcome)
    if record is None or record.confidence is None:
        return ""
    return f" ({percent(record.confidence)})"
