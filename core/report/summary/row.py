"""The row of one take on the page of a batch: verdict, evidence, confidence, notes and files.

Names, sentences and paths come from the people who filmed or shared a take: nothing in them is markup.
"""

import html
import os
from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path, PurePosixPath
from urllib.parse import quote

from ...errors import pluralize
from ...files.paths import escape_control_characters
from ...prior.texts import COMPOSED
from ...review.weak_frames import WEAK_CONFIDENCE
from ...shoot.outcomes import Outcome, Status
from ...take.conversion_record import ConversionRecord
from ...take.evidence import UsedEvidence

LONGEST = 1000


def visible(text: str) -> str:
    r"""A text with invisible and invalid characters spelt out, as `\u202e`, cut at `LONGEST` characters.

    Spelt out are control characters, line breaks, surrogates (bytes of a file name that are not UTF-8) and
    marks that change the direction of writing.
    """
    shown = text if len(text) <= LONGEST else f"{text[:LONGEST]} ..."
    return escape_control_characters(shown)


def escaped(text: str) -> str:
    """`visible` text, escaped for use between tags or within a quoted attribute."""
    return html.escape(visible(text), quote=True)


def isolated(text: str) -> str:
    """`escaped` text in an element that isolates its direction of writing."""
    return f"<bdi>{escaped(text)}</bdi>"


def relative_path(folder: Path, output: Path) -> str:
    """Path of a folder relative to a page in `output`, with slashes."""
    return os.path.relpath(folder, output).replace(os.sep, "/")


def address(*parts: str) -> str:
    """A percent-encoded relative link; no character of the parts can end it or add a scheme."""
    path = "/".join(parts)
    return html.escape(quote(path.encode("utf-8", "surrogatepass"), safe="/"), quote=True)


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
    records = {outcome.take: current_record(outcome) for outcome in outcomes}
    confidence = {take: (record and record.confidence) or 0.0 for take, record in records.items()}
    for outcome in sorted(outcomes, key=lambda one: (confidence[one.take], one.take)):
        found[verdict(outcome)].append(outcome)
    return {kind: those for kind, those in found.items() if those}


COLUMNS = ("Take", "Footage", "Confidence", "To do and to know", "Files")
MOST_NAMED = 12
SIGNS = {
    Verdict.FAILED: "✕",
    Verdict.POOR: "○",
    Verdict.FAIR: "◐",
    Verdict.GOOD: "●",
    Verdict.UNJUDGED: "–",
    Verdict.WAITING: "…",
}
REPORT = "report/"
PICTURE = f"{REPORT}overlay.png"
"""The picture that stands for a take; the page shows a part, a click all of it."""
FILE_ORDER = (".blend", ".bvh", ".json")


def row(outcome: Outcome, output: Path, number: int) -> str:
    """The row of one take."""
    path, record = relative_path(outcome.folder, output), current_record(outcome)
    if record is None:
        cells = f'<td role="cell" colspan="{len(COLUMNS) - 1}">{_no_result(outcome)}</td>'
    else:
        found = verdict(outcome)
        shown = (_footage(path, record), _confidence(record, found), _to_do(record), _files(path, record))
        cells = "".join(f'<td role="cell">{cell}</td>' for cell in shown)
    confidence = "" if record is None or record.confidence is None else f"{record.confidence:.4f}"
    return (
        f'<tr role="row" id="take-{number}" data-order="{number}" data-confidence="{confidence}">'
        f'<th role="rowheader" scope="row">{_name(outcome, path)}</th>{cells}</tr>'
    )


def css_class(found: Verdict) -> str:
    """The verdict's name in anchors and style classes."""
    return found.value.replace(" ", "-")


def _name(outcome: Outcome, path: str) -> str:
    before, slash, last = outcome.take.rpartition("/")
    folder = f'<span class="folder">{escaped(before)}/</span><wbr>' if slash else ""
    name = f"<bdi>{folder}<span>{escaped(last)}</span></bdi>"
    if outcome.record is not None:
        name = f'<a href="{address(path, "")}">{name}</a>'
    worked = "" if outcome.seconds is None else f" in {duration(outcome.seconds)}"
    return name + _small(outcome.status.value + (worked if outcome.status is Status.CONVERTED else ""))


def _footage(path: str, record: ConversionRecord) -> str:
    length = f"{pluralize(record.frames, 'frame')}, {duration(record.frames / record.fps)}"
    words = f"<small>{length} at {record.fps:g} frames a second; {_made_from(record)}</small>"
    if PICTURE not in record.files:
        return words
    file = address(path, PICTURE)
    picture = (
        f'<a class="frames" href="{file}"><img src="{file}" loading="lazy" '
        'decoding="async" alt="frames of the footage with the skeleton over them"></a>'
    )
    return picture + words


def _made_from(record: ConversionRecord) -> str:
    found, doubtful = len(record.matched), len(record.doubtful)
    posed = len(record.keyframes) - found
    counts = [f"{count} {word}" for count, word in ((posed, "posed"), (found, "found")) if count]
    keyframes = "keyframe" if len(record.keyframes) == 1 else "keyframes"
    keyframes += f" ({doubtful} doubtful)" if doubtful else ""
    library = "" if record.library is None else f", library {isolated(record.library)}"
    library = ", all libraries" if record.library == COMPOSED else library
    evidence = "" if record.evidence is None else f"{_evidence(record.evidence)}; "
    return f"{evidence}{' and '.join(counts) or 'no'} {keyframes}{library}, method {escaped(record.method)}"


def _evidence(evidence: UsedEvidence) -> str:
    sources = [isolated(one.source) for one in evidence.keypoints[:3]]
    more = len(evidence.keypoints) - len(sources)
    named = f" (keypoints: {', '.join(sources)}{f' and {more} more' if more else ''})" if sources else ""
    return f"{evidence.words}{named}"


def _confidence(record: ConversionRecord, found: Verdict) -> str:
    word = f'<b class="{css_class(found)}"><span aria-hidden="true">{SIGNS[found]}</span> {found.value}</b>'
    if record.confidence is None:
        return word
    marks = (
        '<rect class="track" width="100" height="6"/>'
        f'<rect width="{100 * record.confidence:.0f}" height="6"/>'
    )
    weakest = ""
    if record.weakest is not None:
        marks += f'<rect class="tick" x="{99 * record.weakest:.0f}" width="1" height="6"/>'
        weakest = _small(f"weakest twentieth {percent(record.weakest)}")
    return (
        f'<span class="share">{percent(record.confidence)}</span> {word}<svg class="{css_class(found)}" '
        f'viewBox="0 0 100 6" preserveAspectRatio="none" aria-hidden="true">{marks}</svg>{weakest}'
    )


def _no_result(outcome: Outcome) -> str:
    text = ""
    if outcome.status is Status.FAILED:
        text = f'<p class="error">{isolated(outcome.error or "It is not known why.")}</p>'
    if outcome.record is not None:
        text += "<p><small>An earlier result is still in its folder.</small></p>"
    return text


def _to_do(record: ConversionRecord) -> str:
    frames = ""
    if record.weak_frames:
        first, *rest = record.weak_frames[:MOST_NAMED]
        then = f", then {', '.join(str(frame) for frame in rest)}" if rest else ""
        more = " and more" if len(record.weak_frames) > MOST_NAMED else ""
        frames = f"<p>Worth a keyframe: frame <b>{first}</b>{then}{more}</p>"
    notes = [f"<li>{isolated(note)}</li>" for note in record.notes[:MOST_NAMED]]
    if len(record.notes) > MOST_NAMED:
        notes.append(f"<li>{len(record.notes) - MOST_NAMED} more in conversion.json</li>")
    return frames + (f"<ul>{''.join(notes)}</ul>" if notes else "")


def _files(path: str, record: ConversionRecord) -> str:
    results = [name for name in record.files if not name.startswith(REPORT)]
    pictures = [name for name in record.files if name.startswith(REPORT)]
    results.sort(key=lambda name: (*(not name.endswith(ending) for ending in FILE_ORDER), name))
    lines = [", ".join(_link(path, name, name) for name in results)]
    lines.append(", ".join(_link(path, name, PurePosixPath(name).stem) for name in pictures))
    return "<br>".join(line for line in lines if line)


def _link(path: str, name: str, words: str) -> str:
    return f'<a href="{address(path, name)}">{isolated(words)}</a>'


def _small(text: str) -> str:
    return f"<small>{escaped(text)}</small>"
