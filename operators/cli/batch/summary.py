"""The summary of a batch: JSON Lines with one take each for programs, and an HTML page for people."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ....core.files.json_file import write_atomically
from ....core.files.paths import absolute_path
from ....core.report.summary.html_text import relative_path
from ....core.report.summary.page import summary_page
from ....core.report.summary.verdict import current_record
from ....core.shoot.outcomes import Outcome
from ....core.shoot.shoot import Shoot
from ....core.take.conversion_record import RECORD_FILE as RECORD

LINES, PAGE = "summary.jsonl", "summary.html"


def write_summary(output: Path, shoot: Shoot, outcomes: Sequence[Outcome]) -> tuple[Path, ...]:
    """Write `summary.jsonl` and `summary.html`, each atomically; of several writers, the last one counts.

    Returns:
        Paths of both files.

    Raises:
        ConversionError: A file cannot be written.
    """
    ordered = sorted(outcomes, key=lambda outcome: outcome.take)
    # ASCII: no letter of a name can be taken for the end of a line, or be refused by a disk or a terminal.
    lines = "".join(f"{json.dumps(summary_line(outcome, output), allow_nan=False)}\n" for outcome in ordered)
    page = summary_page(absolute_path(shoot.path).name, ordered, output)
    for name, text in ((LINES, lines), (PAGE, page)):
        write_atomically(output / name, lambda staged, text=text: _write(staged, text))
    return (output / LINES, output / PAGE)


def summary_line(outcome: Outcome, output: Path) -> dict[str, Any]:
    """One take as an object; fields of its record are null where the record is not of this input."""
    fields: dict[str, Any] = {
        "take": outcome.take,
        "status": outcome.status.value,
        "error": outcome.error,
        "seconds": None if outcome.seconds is None else round(outcome.seconds, 3),
    }
    record = current_record(outcome)
    for name in ("notes", "confidence", "weakest", "weak_frames", "frames", "frame_start", "fps"):
        fields[name] = None if record is None else getattr(record, name)
    for name in ("method", "library", "keyframes", "matched", "doubtful"):
        fields[name] = None if record is None else getattr(record, name)
    evidence = None if record is None else record.evidence
    fields["evidence"] = None if evidence is None else evidence.to_json()
    path = relative_path(outcome.folder, output)
    names = () if record is None else (*record.files, RECORD)
    return {**fields, "files": [name if path == "." else f"{path}/{name}" for name in names]}


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8", newline="\n")
