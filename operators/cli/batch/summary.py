"""The summary of a batch: one line a take for programs, and one page for people."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ....core.files.json_file import write_atomically
from ....core.files.paths import absolute_path
from ....core.report.summary.html_text import way_to
from ....core.report.summary.page import summary_page
from ....core.report.summary.verdict import result
from ....core.shoot.outcomes.outcome import Outcome
from ....core.shoot.shoot import Shoot
from ....core.take.conversion_record import RECORD_FILE as RECORD

LINES, PAGE = "summary.jsonl", "summary.html"


def write_summary(output: Path, shoot: Shoot, outcomes: Sequence[Outcome]) -> tuple[Path, ...]:
    """Write `summary.jsonl` and `summary.html`, each whole; where several do so at once, the last one counts.

    Args:
        output: Folder of the results of all takes.
        shoot: What was converted.
        outcomes: What became of each of its takes.

    Returns:
        The files.

    Raises:
        ConversionError: A file cannot be written.
    """
    ordered = sorted(outcomes, key=lambda outcome: outcome.take)
    # ASCII: no letter of a name can be taken for the end of a line, or be refused by a disk or a terminal.
    lines = "".join(f"{json.dumps(line(outcome, output), allow_nan=False)}\n" for outcome in ordered)
    page = summary_page(absolute_path(shoot.path).name, ordered, output)
    for name, text in ((LINES, lines), (PAGE, page)):
        write_atomically(output / name, lambda beside, text=text: _write(beside, text))
    return (output / LINES, output / PAGE)


def line(outcome: Outcome, output: Path) -> dict[str, Any]:
    """What programs learn of one take; what a record says counts where it is of this input."""
    said: dict[str, Any] = {
        "take": outcome.take,
        "status": outcome.status.value,
        "error": outcome.error,
        "seconds": None if outcome.seconds is None else round(outcome.seconds, 3),
    }
    record = result(outcome)
    for name in ("notes", "confidence", "weakest", "weak_frames", "frames", "frame_start", "fps"):
        said[name] = None if record is None else getattr(record, name)
    for name in ("method", "library", "keyframes", "matched"):
        said[name] = None if record is None else getattr(record, name)
    way = way_to(outcome.folder, output)
    names = () if record is None else (*record.files, RECORD)
    return {**said, "files": [name if way == "." else f"{way}/{name}" for name in names]}


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8", newline="\n")
