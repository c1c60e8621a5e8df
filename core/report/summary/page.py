"""The HTML page of a batch for its supervisor: one file, complete without its script.

Words never stand on any color of `style.css` but paper, card and wash.
"""

import base64
import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from ...errors import pluralize
from ...shoot.outcomes import Outcome, Status
from .row import (
    COLUMNS,
    FAIR,
    GOOD,
    GOOD_WEAKEST,
    SIGNS,
    Verdict,
    css_class,
    current_record,
    duration,
    escaped,
    isolated,
    percent,
    row,
    sections,
)

FOLDER = Path(__file__).parent

STYLE = (FOLDER / "style.css").read_text(encoding="utf-8")
SCRIPT = "\n" + (FOLDER / "script.js").read_text(encoding="utf-8")


MOST_NAMED = 3


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
    """The takes that a supervisor should turn to first, a sentence for each kind."""
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


MOST_ROWS = 5000
"""Largest number of takes on the page; browsers are slow to lay out more."""
HEADINGS = {
    Verdict.FAILED: ("Failed", "The sentence says what would be valid."),
    Verdict.POOR: ("Poor", "Pose the frames that are named and convert again."),
    Verdict.FAIR: ("Fair", "Look at the frames that are named; a few keyframes there make them good."),
    Verdict.UNJUDGED: ("Not judged", "The method does not say how sure it is."),
    Verdict.GOOD: ("Good", "Usable as they are; the frames that are named would gain most from a keyframe."),
    Verdict.WAITING: ("Waiting", "Their turn has not come, or the batch was interrupted: run it again."),
}


def summary_page(title: str, outcomes: Sequence[Outcome], output: Path) -> str:
    """A batch as one HTML page."""
    named = sorted(outcomes, key=lambda outcome: outcome.take)
    number = {outcome.take: position for position, outcome in enumerate(named, 1)}
    found = sections(outcomes)
    bodies, free_rows = [], MOST_ROWS
    for verdict, those in found.items():
        bodies.append(_section(verdict, those[:free_rows], len(those), output, number))
        free_rows -= min(free_rows, len(those))
    heads = "".join(f'<th role="columnheader" scope="col">{name}</th>' for name in COLUMNS)
    parts = (
        f"<header><h1>{isolated(title)}</h1>",
        counts(outcomes),
        urgent_items(found, number),
        "</header>",
        _navigation(found),
        '<main><table role="table"><caption>Takes, those that need a person first</caption>',
        f'<thead role="rowgroup"><tr role="row">{heads}</tr></thead>',
        *bodies,
        "</table></main>",
        _legend(),
        _by_name(named[:MOST_ROWS], number),
    )
    return _document(f"{title}: {pluralize(len(outcomes), 'take')}", "\n".join(parts))


def _document(title: str, body: str) -> str:
    allowed = (
        "default-src 'none'; img-src 'self' file:; base-uri 'none'; form-action 'none'; "
        f"style-src {_source(STYLE)}; script-src {_source(SCRIPT)}"
    )
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{allowed}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n<meta name="referrer" content="no-referrer">\n'
        f"<title>{escaped(title)}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
        f"{body}\n<script>{SCRIPT}</script>\n</body>\n</html>\n"
    )


def _source(text: str) -> str:
    """The hash by which the Content Security Policy allows this style or script, and no other."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _section(
    verdict: Verdict, outcomes: Sequence[Outcome], count: int, output: Path, number: Mapping[str, int]
) -> str:
    word, advice = HEADINGS[verdict]
    if len(outcomes) < count:
        advice += f" {count - len(outcomes)} of them are in summary.jsonl alone."
    rows = "\n".join(row(outcome, output, number[outcome.take]) for outcome in outcomes)
    return (
        f'<tbody role="rowgroup" id="{css_class(verdict)}"><tr role="row" class="section">'
        f'<th role="rowheader" scope="rowgroup" colspan="{len(COLUMNS)}"><h2 class="{css_class(verdict)}">'
        f'<span aria-hidden="true">{SIGNS[verdict]}</span> {word} <span class="count">{count}</span>'
        f"</h2> <small>{advice}</small></th></tr>\n{rows}</tbody>"
    )


def _navigation(found: dict[Verdict, list[Outcome]]) -> str:
    links = "".join(
        f'<a class="{css_class(verdict)}" href="#{css_class(verdict)}">'
        f'<span aria-hidden="true">{SIGNS[verdict]}</span> {len(those)} {verdict.value}</a>'
        for verdict, those in found.items()
    )
    return (
        f'<nav aria-label="Sections">{links}<a href="#names">all by name</a>'
        '<form id="tools" role="search" hidden><label>Find <input id="find" type="search" '
        'placeholder="name, note, library ..." autocomplete="off"></label><label>Order <select id="order">'
        '<option value="need">by need</option><option value="name">by name</option>'
        '<option value="confidence">by confidence</option></select></label>'
        '<output id="found" aria-live="polite"></output></form></nav>'
    )


def _legend() -> str:
    good, fair, weakest = (percent(share) for share in (GOOD, FAIR, GOOD_WEAKEST))
    return (
        '<section id="legend"><h2>How to read this page</h2><p>Confidence is the expected share of the '
        "body\u2019s joints that lie within a fortieth of the performer\u2019s height of their true places, "
        "as a mean over all frames; the mark on the bar is what one frame in twenty falls short of. "
        f"<b>Good</b> is a mean of at least {good} and a weakest twentieth of at least {weakest}, "
        f"<b>fair</b> a mean of at least {fair}, <b>poor</b> anything below. Frames worth a keyframe are "
        "scene frames, the one that helps most first. On the pictures the performer\u2019s left limbs are "
        "solid and blue, the right ones hollow and red; a click shows all of them, larger.</p></section>"
    )


def _by_name(named: Sequence[Outcome], number: dict[str, int]) -> str:
    items = "".join(
        f'<li><a href="#take-{number[outcome.take]}">{isolated(outcome.take)}</a>'
        + ("" if outcome.status is Status.CONVERTED else f" <small>{outcome.status.value}</small>")
        + "</li>"
        for outcome in named
    )
    return f'<section id="names"><h2>All takes by name</h2><ol>{items}</ol></section>'
