"""The row of one take on the page of a batch."""

from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from ...library.several_libraries import COMPOSED
from ...shoot.outcomes import Outcome, Status
from ...take.conversion_record import ConversionRecord
from ...take.used_evidence import UsedEvidence
from ...text import pluralize
from .html_text import address, duration, escaped, isolated, percent, relative_path
from .verdict import Verdict, current_record, verdict

COLUMNS = ("Take", "Footage", "Confidence", "To do and to know", "Files")
MOST_NAMED = 12
"""Weak frames and notes shown; `conversion.json` has all."""
MOST_SOURCES = 3
"""Sources of keypoints named."""
SIGNS = {
    Verdict.FAILED: "✕",
    Verdict.POOR: "○",
    Verdict.FAIR: "◐",
    Verdict.GOOD: "●",
    Verdict.UNJUDGED: "–",
    Verdict.WAITING: "…",
}
"""Signs of the verdicts, beside their words and colors."""
REPORT = "report/"
PICTURE = f"{REPORT}overlay.png"
"""The picture that stands for a take; the page shows a part, a click all of it."""
FILE_ORDER = (".blend", ".bvh", ".json")
"""Suffixes of the files that people open, the most common first."""


def row(outcome: Outcome, output: Path, number: int) -> str:
    """The row of one take.

    Args:
        outcome: The take's outcome.
        output: Folder of the page.
        number: The take's number in the order of names, for its anchor.
    """
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
    """What a take was held against, with the names of the sources of its keypoints."""
    sources = [isolated(said.source) for said in evidence.keypoints[:MOST_SOURCES]]
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
    frames = f"<p>Worth a keyframe: {_frames(record.weak_frames)}</p>" if record.weak_frames else ""
    notes = [f"<li>{isolated(note)}</li>" for note in record.notes[:MOST_NAMED]]
    if len(record.notes) > MOST_NAMED:
        notes.append(f"<li>{len(record.notes) - MOST_NAMED} more in conversion.json</li>")
    return frames + (f"<ul>{''.join(notes)}</ul>" if notes else "")


def _frames(weak: Sequence[int]) -> str:
    first, *others = weak[:MOST_NAMED]
    then = f", then {', '.join(str(frame) for frame in others)}" if others else ""
    return f"frame <b>{first}</b>{then}" + (" and more" if len(weak) > MOST_NAMED else "")


def _files(path: str, record: ConversionRecord) -> str:
    results = [name for name in record.files if not name.startswith(REPORT)]
    pictures = [name for name in record.files if name.startswith(REPORT)]
    lines = [", ".join(_link(path, name, name) for name in sorted(results, key=_file_order))]
    lines.append(", ".join(_link(path, name, PurePosixPath(name).stem) for name in pictures))
    return "<br>".join(line for line in lines if line)


def _link(path: str, name: str, words: str) -> str:
    return f'<a href="{address(path, name)}">{isolated(words)}</a>'


def _file_order(name: str) -> tuple[int, str]:
    suffix = PurePosixPath(name).suffix
    return (FILE_ORDER.index(suffix) if suffix in FILE_ORDER else len(FILE_ORDER), name)


def _small(text: str) -> str:
    return f"<small>{escaped(text)}</small>"
