"""The HTML page of a batch for its supervisor: a row a take, those that need work first; no script.

Names, sentences and paths come from the people who filmed or shared a take: nothing in them is markup. Words
never stand on any color of `batch_page.css` but paper, card and wash.
"""

import base64
import hashlib
import html
import os
from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path, PurePosixPath
from urllib.parse import quote

from ..errors import pluralize
from ..files.paths import escape_control_characters
from ..prior.texts import COMPOSED
from ..review.weak_frames import WEAK_CONFIDENCE
from ..shoot.outcomes import Outcome, Status
from ..take.conversion_record import ConversionRecord

STYLE = Path(__file__).with_suffix(".css").read_text(encoding="utf-8")
LONGEST = 1000  # letters of a text
MOST_ROWS = 5000  # largest number of takes on the page; browsers are slow to lay out more
MOST_NAMED = 12  # frames and notes of a take
GOOD = WEAK_CONFIDENCE  # mean confidence of a good take: such frames need no keyframe
FAIR = 0.5
"""Mean confidence from which a take is fair (below, most joints are likely off), and the least one of the
weakest twentieth of a good take's frames."""


class Verdict(StrEnum):
    """State of a take, the most urgent first."""

    FAILED = "failed"
    POOR = "poor"
    FAIR = "fair"
    UNJUDGED = "not judged"  # by a method without a confidence
    GOOD = "good"
    WAITING = "waiting"


HEADINGS = {
    Verdict.FAILED: ("✕", "The sentence says what would be valid."),
    Verdict.POOR: ("○", "Pose the frames that are named and convert again."),
    Verdict.FAIR: ("◐", "Look at the frames that are named; a few keyframes there make them good."),
    Verdict.UNJUDGED: ("–", "The method does not say how sure it is."),
    Verdict.GOOD: ("●", "Usable as they are; the frames that are named would gain most from a keyframe."),
    Verdict.WAITING: ("…", "Their turn has not come, or the batch was interrupted: run it again."),
}
"""A sign and an advice for each section."""
COLUMNS = ("Take", "Footage", "Confidence", "To do and to know", "Files")
PICTURE = "report/overlay.png"  # stands for a take; the page shows a part, a click all of it


def visible(text: str) -> str:
    r"""A text with invisible and invalid characters spelt out, as `\u202e`, cut at `LONGEST` characters.

    Spelt out are control characters, line breaks, surrogates (bytes of a file name that are not UTF-8) and
    marks that change the direction of writing.
    """
    return escape_control_characters(text if len(text) <= LONGEST else f"{text[:LONGEST]} ...")


def isolated(text: str) -> str:
    """`visible` text, escaped, in an element that isolates its direction of writing."""
    return f"<bdi>{html.escape(visible(text))}</bdi>"


def relative_path(folder: Path, output: Path) -> str:
    """Path of a folder relative to a page in `output`, with slashes."""
    return os.path.relpath(folder, output).replace(os.sep, "/")


def address(*parts: str) -> str:
    """A percent-encoded relative link; no character of the parts can end it or add a scheme."""
    path = "/".join(parts)
    return html.escape(quote(path.encode("utf-8", "surrogatepass"), safe="/"))


def percent(share: float) -> str:
    """A share from 0 to 1 in percent, rounded down: a value below a threshold never appears to reach it."""
    return f"{int(100.0 * share + 1e-9)}\u00a0%"


def duration(seconds: float) -> str:
    """A duration for people: `3.9 s`, `4 min 5 s`, `2 h 10 min`."""
    if seconds < 59.95:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"


def current_record(outcome: Outcome) -> ConversionRecord | None:
    """The record of a take's result; None without a result of the present input."""
    return outcome.record if outcome.status in (Status.CONVERTED, Status.UNCHANGED) else None


def verdict(outcome: Outcome) -> Verdict:
    """The verdict on a take; of a result by its warnings, its mean confidence and its weakest twentieth's."""
    if outcome.status is Status.FAILED:
        return Verdict.FAILED
    record = current_record(outcome)
    if record is None:
        return Verdict.WAITING
    if record.warnings:
        return Verdict.POOR
    if record.confidence is None:
        return Verdict.UNJUDGED
    if record.confidence >= GOOD and (record.weakest is None or record.weakest >= FAIR):
        return Verdict.GOOD
    return Verdict.FAIR if record.confidence >= FAIR else Verdict.POOR


def sections(outcomes: Sequence[Outcome]) -> dict[Verdict, list[Outcome]]:
    """Takes by verdict, without empty verdicts; sorted by confidence, the least first, then by name."""
    found: dict[Verdict, list[Outcome]] = {kind: [] for kind in Verdict}
    records = {outcome.take: current_record(outcome) for outcome in outcomes}
    confidence = {take: (record and record.confidence) or 0.0 for take, record in records.items()}
    for outcome in sorted(outcomes, key=lambda one: (confidence[one.take], one.take)):
        found[verdict(outcome)].append(outcome)
    return {kind: those for kind, those in found.items() if those}


def summary_page(title: str, outcomes: Sequence[Outcome], output: Path) -> str:
    """A batch as one HTML page."""
    bodies, free_rows = [], MOST_ROWS
    for kind, those in sections(outcomes).items():
        shown = those[:free_rows]
        free_rows -= len(shown)
        sign, advice = HEADINGS[kind]
        if len(shown) < len(those):
            advice += f" {len(those) - len(shown)} of them are in summary.jsonl alone."
        rows = "\n".join(_row(outcome, kind, output) for outcome in shown)
        bodies.append(
            '<tbody role="rowgroup"><tr role="row" class="section">'
            f'<th role="rowheader" scope="rowgroup" colspan="{len(COLUMNS)}"><h2 class="{kind.name.lower()}">'
            f'<span aria-hidden="true">{sign}</span> {kind.value.capitalize()} '
            f'<span class="count">{len(those)}</span></h2> <small>{advice}</small></th></tr>\n{rows}</tbody>'
        )
    body = "\n".join(bodies)
    heads = "".join(f'<th role="columnheader" scope="col">{name}</th>' for name in COLUMNS)
    # The hash by which the Content Security Policy allows this style alone.
    style = base64.b64encode(hashlib.sha256(STYLE.encode()).digest()).decode()
    allowed = (
        "default-src 'none'; img-src 'self' file:; base-uri 'none'; form-action 'none'; "
        f"style-src 'sha256-{style}'"
    )
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{allowed}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n<meta name="referrer" content="no-referrer">\n'
        f"<title>{html.escape(visible(title))}: {pluralize(len(outcomes), 'take')}</title>\n"
        f"<style>{STYLE}</style>\n</head>\n<body>\n"
        f"<header><h1>{isolated(title)}</h1>{_counts(outcomes)}</header>\n"
        '<main><table role="table"><caption>Takes, those that need a person first</caption>\n'
        f'<thead role="rowgroup"><tr role="row">{heads}</tr></thead>\n'
        f"{body}</table></main>\n"
        "<footer>Confidence is the expected share of the body\u2019s joints that lie within a fortieth of "
        "the performer\u2019s height of their true places; the mark on the bar is what one frame in twenty "
        "falls short of. Frames are the scene\u2019s, the one that helps most first. On the pictures left "
        "limbs are solid and blue, right ones hollow and red.</footer>\n</body>\n</html>\n"
    )


def _counts(outcomes: Sequence[Outcome]) -> str:
    """The numbers of takes by status, and the amount of footage converted."""
    done = [record for record in map(current_record, outcomes) if record is not None]
    figures: list[tuple[str, int | str]] = [("takes", len(outcomes))]
    figures += [(each.value, sum(outcome.status is each for outcome in outcomes)) for each in Status]
    figures.append(("frames", sum(record.frames for record in done)))
    figures.append(("footage", duration(sum(record.frames / record.fps for record in done))))
    return f"<dl>{''.join(f'<div><dt>{name}</dt><dd>{value}</dd></div>' for name, value in figures)}</dl>"


def _row(outcome: Outcome, kind: Verdict, output: Path) -> str:
    path, record = relative_path(outcome.folder, output), current_record(outcome)
    if record is None:
        text = ""
        if outcome.status is Status.FAILED:
            text = f'<p class="error">{isolated(outcome.error or "It is not known why.")}</p>'
        if outcome.record is not None:
            text += "<p><small>An earlier result is still in its folder.</small></p>"
        cells = f'<td role="cell" colspan="{len(COLUMNS) - 1}">{text}</td>'
    else:
        shown = (_footage(path, record), _confidence(record, kind), _to_do(record), _files(path, record))
        cells = "".join(f'<td role="cell">{cell}</td>' for cell in shown)
    name = isolated(outcome.take)
    if outcome.record is not None:
        name = f'<a href="{address(path, "")}">{name}</a>'
    timed = outcome.seconds is not None and outcome.status is Status.CONVERTED
    worked = f" in {duration(outcome.seconds or 0.0)}" if timed else ""
    head = f"{name}<small>{outcome.status.value}{worked}</small>"
    return f'<tr role="row" class="take"><th role="rowheader" scope="row">{head}</th>{cells}</tr>'


def _footage(path: str, record: ConversionRecord) -> str:
    length = f"{pluralize(record.frames, 'frame')}, {duration(record.frames / record.fps)}"
    evidence = ""
    if record.evidence is not None:
        sources = ", ".join(isolated(each.source) for each in record.evidence.keypoints)
        evidence = f"{record.evidence.words}{f' (keypoints: {sources})' if sources else ''}; "
    found, doubtful = len(record.matched), len(record.doubtful)
    posed = len(record.keyframes) - found
    counts = [f"{count} {word}" for count, word in ((posed, "posed"), (found, "found")) if count]
    keyframes = "keyframe" if len(record.keyframes) == 1 else "keyframes"
    keyframes += f" ({doubtful} doubtful)" if doubtful else ""
    library = "" if record.library is None else f", library {isolated(record.library)}"
    library = ", all libraries" if record.library == COMPOSED else library
    words = (
        f"<small>{length} at {record.fps:g} frames a second; {evidence}{' and '.join(counts) or 'no'} "
        f"{keyframes}{library}, method {isolated(record.method)}</small>"
    )
    if PICTURE not in record.files:
        return words
    file = address(path, PICTURE)
    return (
        f'<a href="{file}"><img src="{file}" loading="lazy" decoding="async" '
        f'alt="frames of the footage with the skeleton over them"></a>{words}'
    )


def _confidence(record: ConversionRecord, kind: Verdict) -> str:
    word = f'<b class="{kind.name.lower()}">{HEADINGS[kind][0]} {kind.value}</b>'
    if record.confidence is None:
        return word
    bar = '<rect class="track" width="100" height="6"/>'
    bar += f'<rect width="{100 * record.confidence:.0f}" height="6"/>'
    weakest = ""
    if record.weakest is not None:
        bar += f'<rect class="tick" x="{99 * record.weakest:.0f}" width="1" height="6"/>'
        weakest = f"<small>weakest twentieth {percent(record.weakest)}</small>"
    return (
        f'<span class="share">{percent(record.confidence)}</span> {word}<svg class="{kind.name.lower()}" '
        f'viewBox="0 0 100 6" preserveAspectRatio="none" aria-hidden="true">{bar}</svg>{weakest}'
    )


def _to_do(record: ConversionRecord) -> str:
    frames = ""
    if record.weak_frames:
        first, *rest = record.weak_frames[:MOST_NAMED]
        then = f", then {', '.join(map(str, rest))}" if rest else ""
        more = " and more" if len(record.weak_frames) > MOST_NAMED else ""
        frames = f"<p>Worth a keyframe: frame <b>{first}</b>{then}{more}</p>"
    notes = [f"<li>{isolated(note)}</li>" for note in record.notes[:MOST_NAMED]]
    if len(record.notes) > MOST_NAMED:
        notes.append(f"<li>{len(record.notes) - MOST_NAMED} more in conversion.json</li>")
    notes = [*(f"<li><b>{isolated(warning)}</b></li>" for warning in record.warnings), *notes]
    return frames + (f"<ul>{''.join(notes)}</ul>" if notes else "")


def _files(path: str, record: ConversionRecord) -> str:
    """Links to a result's files, and below them those to its pictures."""
    endings = (".blend", ".bvh", ".json")
    lines: list[list[str]] = [[], []]
    for name in sorted(record.files, key=lambda name: (*(not name.endswith(one) for one in endings), name)):
        picture = name.startswith("report/")
        words = isolated(PurePosixPath(name).stem if picture else name)
        lines[picture].append(f'<a href="{address(path, name)}">{words}</a>')
    return "<br>".join(", ".join(links) for links in lines if links)
