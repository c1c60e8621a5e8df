"""The summary of a batch: what became of every take, for programs and for people."""

import json
from collections.abc import Sequence
from pathlib import Path

from ....core.files.json_file import write_whole
from ....core.shoot.outcome import Outcome
from ....core.shoot.shoot import Shoot

LINES = "summary.jsonl"


def write_summary(output: Path, shoot: Shoot, outcomes: Sequence[Outcome]) -> tuple[Path, ...]:
    """Write what became of every take into the folder of the results.

    Raises:
        ConversionError: A file cannot be written.
    """
    rows = (
        {"take": outcome.take, "status": outcome.status.value, "error": outcome.error} for outcome in outcomes
    )
    text = "".join(json.dumps(row) + "\n" for row in rows)
    write_whole(output / LINES, lambda beside: beside.write_text(text, encoding="utf-8", newline="\n"))
    return (output / LINES,)
