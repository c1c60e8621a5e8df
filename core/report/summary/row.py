"""One take of a batch as a row of the page that a supervisor reads."""

from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from ...shoot.outcomes.outcome import Outcome, Status
from ...take.conversion_record import ConversionRecord
from ...text import pluralize
from ..film_strip import PICTURES as STRIP_FRAMES
from ..film_strip import SIZE as STRIP_SIZE
from ..pictures import STRIP
from .html_text import address, duration, escaped, isolated, percent, way_to
from .verdict import Verdict, result, verdict

COLUMNS = ("Take", "Footage", "Confidence", "To do and to know", "Files")
MOST_NAMED = 12
"""Weak frames and notes that are shown; `conversion.json` has all."""
SIGNS = {
    Verdict.FAILED: "✕",
    Verdict.POOR: "○",
    Verdict.FAIR: "◐",
    Verdict.GOOD: "●",
    Verdict.UNJUDGED: "–",
    Verdict.WAITING: "…",
}
"""Beside the word and the color."""
REPORT = "report/"
LARGER = f"{REPORT}overlay.png"
WANTED = (".blend", ".bvh", ".json")
"""Files that people open, the likeliest first."""


def row(outcome: Outcome, output: Path, number: int) -> str:
    """The row of one take.

    Args:
        outcome: What became of it.
        output: Where the page lies.
        number: The take's place in the order of names, which its anchor is made of.
    """
    way, record = way_to(outcome.folder, output), result(outcome)
    if record is None:
        cells = f'<td role="cell" colspan="{len(COLUMNS) - 1}">{_no_result(outcome)}</td>'
    else:
        found = verdict(outcome)
        shown = (_footage(way, record), _confidence(record, found), _to_do(record), _files(way, record))
        cells = "".join(f'<td role="cell">{cell}</td>' for cell in shown)
    believed = "" if record is None or record.confidence is None else f"{record.confidence:.4f}"
    return (
        f'<tr role="row" id="take-{number}" data-order="{number}" data-confidence="{believed}">'
        f'<th role="rowheader" scope="row">{_name(outcome, way)}</th>{cells}</tr>'
    )


def kind(found: Verdict) -> str:
    """A verdict as a name for anchors and styles."""
    return found.value.replace(" ", "-")


def _name(outcome: Outcome, way: str) -> str:
    before, slash, last = outcome.take.rpartition("/")
    folder = f'<span class="folder">{escaped(before)}/</span><wbr>' if slash else ""
    name = f"<bdi>{folder}<span>{escaped(last)}</span></bdi>"
    if outcome.record is not None:
        name = f'<a href="{address(way, "")}">{name}</a>'
    worked = "" if outcome.seconds is None else f" in {duration(outcome.seconds)}"
    return name + _small(outcome.status.value + (worked if outcome.status is Status.CONVERTED else ""))


def _footage(way: str, record: ConversionRecord) -> str:
    length = f"{pluralize(record.frames, 'frame')}, {duration(record.frames / record.fps)}"
    words = f"<small>{length} at {record.fps:g} frames a second; {_made_from(record)}</small>"
    name = f"{REPORT}{STRIP}"
    if name not in record.files:
        return words
    shown = pluralize(min(STRIP_FRAMES, record.frames), "frame")
    width, height = (pixels // 2 for pixels in STRIP_SIZE)
    picture = (
        f'<img src="{address(way, name)}" width="{width}" height="{height}" loading="lazy" decoding="async" '
        f'alt="{shown} of the footage with the skeleton over them">'
    )
    if LARGER in record.files:
        picture = f'<a class="strip" href="{address(way, LARGER)}">{picture}</a>'
    return picture + words


def _made_from(record: ConversionRecord) -> str:
    matched = len(record.matched)
    posed = len(record.keyframes) - matched
    counts = [f"{count} {word}" for count, word in ((posed, "posed"), (matched, "matched")) if count]
    keyframes = "keyframe" if len(record.keyframes) == 1 else "keyframes"
    library = "" if record.library is None else f", library {isolated(record.library)}"
    return f"{' and '.join(counts) or 'no'} {keyframes}{library}, method {escaped(record.method)}"


def _confidence(record: ConversionRecord, found: Verdict) -> str:
    word = f'<b class="{kind(found)}"><span aria-hidden="true">{SIGNS[found]}</span> {found.value}</b>'
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
        f'<span class="share">{percent(record.confidence)}</span> {word}<svg class="{kind(found)}" '
        f'viewBox="0 0 100 6" preserveAspectRatio="none" aria-hidden="true">{marks}</svg>{weakest}'
    )


def _no_result(outcome: Outcome) -> str:
    said = ""
    if outcome.status is Status.FAILED:
        said = f'<p class="error">{isolated(outcome.error or "It is not known why.")}</p>'
    if outcome.record is not None:
        said += "<p><small>An earlier result is still in its folder.</small></p>"
    return said


def _to_do(record: ConversionRecord) -> str:
    said = f"<p>Worth a keyframe: {_frames(record.weak_frames)}</p>" if record.weak_frames else ""
    notes = [f"<li>{isolated(note)}</li>" for note in record.notes[:MOST_NAMED]]
    if len(record.notes) > MOST_NAMED:
        notes.append(f"<li>{len(record.notes) - MOST_NAMED} more in conversion.json</li>")
    return said + (f"<ul>{''.join(notes)}</ul>" if notes else "")


def _frames(weak: Sequence[int]) -> str:
    first, *others = weak[:MOST_NAMED]
    then = f", then {', '.join(str(frame) for frame in others)}" if others else ""
    return f"frame <b>{first}</b>{then}" + (" and more" if len(weak) > MOST_NAMED else "")


def _files(way: str, record: ConversionRecord) -> str:
    results = [name for name in record.files if not name.startswith(REPORT)]
    pictures = [name for name in record.files if name.startswith(REPORT) and name != f"{REPORT}{STRIP}"]
    lines = [", ".join(_link(way, name, name) for name in sorted(results, key=_likelihood))]
    lines.append(", ".join(_link(way, name, PurePosixPath(name).stem) for name in pictures))
    return "<br>".join(line for line in lines if line)


def _link(way: str, name: str, words: str) -> str:
    return f'<a href="{address(way, name)}">{isolated(words)}</a>'


def _likelihood(name: str) -> tuple[int, str]:
    ending = PurePosixPath(name).suffix
    return (WANTED.index(ending) if ending in WANTED else len(WANTED), name)


def _small(text: str) -> str:
    return f"<small>{escaped(text)}</small>"
