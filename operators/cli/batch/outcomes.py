"""Outcomes of a batch's takes, and its summary: JSON Lines for programs, an HTML page for people."""

import json
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from operator import mul
from pathlib import Path
from typing import Any

from ....core.errors import KeymarkError, pluralize
from ....core.files.json_file import write_atomically
from ....core.files.paths import absolute_path
from ....core.report.batch_page import current_record, relative_path, summary_page
from ....core.shoot.discovery import Shoot
from ....core.shoot.outcomes import (
    CONVERSION,
    Failure,
    Outcome,
    Status,
    read_outcome,
    remove_failure,
    remove_failures_of_deleted_takes,
    write_failure,
)
from ....core.take.conversion_record import RECORD_FILE as RECORD
from ....core.take.conversion_record import ConversionRecord, find_record
from ..console import Console, terminal_columns, wrapped
from .worker_process import FAILED, Done, Job, Step

LINES, PAGE = "summary.jsonl", "summary.html"
RECORDED = (
    *("warnings", "notes", "confidence", "weakest", "weak_frames", "frames", "frame_start", "fps"),
    *("method", "library", "keyframes", "matched", "doubtful"),
)
"""Fields of a take's record that its line of the summary has."""


def write_summary(output: Path, shoot: Shoot, outcomes: Sequence[Outcome]) -> tuple[Path, ...]:
    """Write `summary.jsonl` and `summary.html`, each atomically; of several writers, the last one counts."""
    ordered = sorted(outcomes, key=lambda outcome: outcome.take)
    # ASCII: no letter of a name can be taken for the end of a line, or be refused by a disk or a terminal.
    lines = "".join(f"{json.dumps(summary_line(outcome, output), allow_nan=False)}\n" for outcome in ordered)
    page = summary_page(absolute_path(shoot.path).name, ordered, output)
    files = (output / LINES, output / PAGE)
    for file, text in zip(files, (lines, page), strict=True):
        content = text.encode()
        write_atomically(file, lambda staged, content=content: staged.write_bytes(content))
    return files


def summary_line(outcome: Outcome, output: Path) -> dict[str, Any]:
    """One take as an object; fields of its record are null where the record is not of this input."""
    fields: dict[str, Any] = {
        "take": outcome.take,
        "status": outcome.status.value,
        "error": outcome.error,
        "seconds": None if outcome.seconds is None else round(outcome.seconds, 3),
    }
    record = current_record(outcome)
    for name in RECORDED:
        fields[name] = None if record is None else getattr(record, name)
    evidence = None if record is None else record.evidence
    fields["evidence"] = None if evidence is None else evidence.to_json()
    path = relative_path(outcome.folder, output)
    names = () if record is None else (*record.files, RECORD)
    return {**fields, "files": [name if path == "." else f"{path}/{name}" for name in names]}


class BatchProgress:
    """The share of all work that is done, updated take by take."""

    def __init__(self, frames: Sequence[int | None]) -> None:
        """Begin with nothing done; a take of unknown length, None, counts as the mean of those known."""
        self._frames = list(frames)
        self._done = [0.0] * len(self._frames)

    def update(self, index: int, fraction: float, frames: int | None = None) -> None:
        """Set how much of a take is done, 0 to 1, and its length where that has become known."""
        self._done[index] = fraction
        self._frames[index] = self._frames[index] or frames

    @property
    def fraction(self) -> float:
        """The share of the whole batch, from 0 to 1."""
        known = [frames for frames in self._frames if frames is not None]
        mean = sum(known) / len(known) if known else 1.0
        lengths = [mean if frames is None else frames for frames in self._frames]
        return sum(map(mul, self._done, lengths)) / sum(lengths) if lengths else 1.0


SHORTEST_SUMMARY_INTERVAL_S = 5.0
SUMMARY_SHARE = 0.1
"""Largest share of a batch's time that writing summaries takes, however many takes there are."""
WIDEST_NAME = 40


class BatchOutcomes:
    """Receives the events of a worker pool; counts, shows and stores the outcomes of the takes."""

    def __init__(self, shoot: Shoot, output: Path, jobs: Sequence[Job], console: Console) -> None:
        """Begin with the outcomes that the folder has of all takes."""
        self.shoot, self.output, self.console = shoot, output, console
        self._names = [job.take.name for job in jobs]
        self._outcomes = {take.name: read_outcome(take, output) for take in shoot.takes}
        for name in self._names:
            self._outcomes[name] = replace(self._outcomes[name], status=Status.WAITING, error=None)
        self._counts = Counter({Status.WAITING: len(jobs)})
        self._progress = BatchProgress([_frame_count(self._outcomes[name].record) for name in self._names])
        self._indices = {name: index for index, name in enumerate(self._names)}
        self._width = min(max(map(len, self._names), default=0), WIDEST_NAME)
        self._next_summary = time.monotonic()
        self.files: tuple[Path, ...] = ()
        self.write_errors: list[str] = []
        """Sentences on summaries and failures that could not be written."""
        remove_failures_of_deleted_takes(output, shoot)
        self._show_progress()

    @property
    def own_outcomes(self) -> list[Outcome]:
        """Outcomes of the takes that are converted here, in the order of the jobs."""
        return [self._outcomes[name] for name in self._names]

    @property
    def counts(self) -> dict[str, int]:
        """Number of the takes that are converted here, by status."""
        return {status.value: self._counts[status] for status in Status}

    def job_progressed(self, job: Job, step: Step) -> None:
        """Show the progress of a take."""
        self._progress.update(self._indices[job.take.name], step.fraction)
        self._show_progress()

    def job_requeued(self, job: Job, reason: str) -> None:
        """Say why a take is retried later."""
        self._progress.update(self._indices[job.take.name], 0.0)
        self.console.take_line(f"{job.take.name}: {reason}", None)

    def job_finished(self, job: Job, done: Done) -> None:
        """Store and show the outcome of a take; write a summary from time to time."""
        name, record = job.take.name, find_record(job.folder)
        self._progress.update(self._indices[name], 1.0, _frame_count(record))
        if done.result == FAILED:
            try:
                write_failure(self.output, Failure(name, done.error or "failed", done.kind or CONVERSION))
            except KeymarkError as error:
                self._note_write_error(str(error))
        else:
            remove_failure(self.output, name)
        outcome = Outcome(name, job.folder, Status(done.result), record, done.error, done.seconds)
        self._outcomes[name] = outcome
        self._counts.update({outcome.status: 1, Status.WAITING: -1})
        self.console.take_line(self._take_line(outcome), outcome.error and f"{name}: {outcome.error}")
        self._show_progress()
        if time.monotonic() >= self._next_summary:
            self.summarize()

    def finish(self) -> None:
        """Write the final summary, with the outcomes that other machines have left meanwhile."""
        while True:
            others = self._other_outcomes()
            self._outcomes |= others
            self.summarize()
            # Another machine may have finished, and written its own summary, while this one was written:
            # without a second look the summary that stays would lack the last take of that machine.
            after = self._other_outcomes()
            if all(
                (after[name].status, after[name].error, after[name].record)
                == (was.status, was.error, was.record)
                for name, was in others.items()
            ):
                return

    def _other_outcomes(self) -> dict[str, Outcome]:
        here = set(self._names)
        return {
            take.name: read_outcome(take, self.output) for take in self.shoot.takes if take.name not in here
        }

    def summarize(self) -> None:
        """Write the summary of the outcomes so far."""
        started = time.monotonic()
        try:
            self.files = write_summary(self.output, self.shoot, list(self._outcomes.values()))
        except KeymarkError as error:
            self._note_write_error(str(error))
        now = time.monotonic()
        self._next_summary = now + max(SHORTEST_SUMMARY_INTERVAL_S, (now - started) / SUMMARY_SHARE)

    def to_dict(self) -> dict[str, Any]:
        """The outcomes as an object for `--json`."""
        return {
            "shoot": str(self.shoot.path),
            "output": str(self.output),
            "counts": self.counts,
            "takes": [
                {
                    "take": outcome.take,
                    "folder": str(outcome.folder),
                    "status": outcome.status.value,
                    "error": outcome.error,
                    "confidence": None if outcome.record is None else outcome.record.confidence,
                    "seconds": None if outcome.seconds is None else round(outcome.seconds, 3),
                }
                for outcome in self.own_outcomes
            ],
            "files": [str(file) for file in self.files],
        }

    def text(self) -> str:
        """The outcomes as lines for people, failures with their reasons."""
        counts = ", ".join(f"{count} {name}" for name, count in self.counts.items() if count)
        failed = [outcome for outcome in self.own_outcomes if outcome.status is Status.FAILED]
        lines = [f"{pluralize(len(self._names), 'take')}: {counts}."]
        if failed:
            lines.append("Failed:")
            for outcome in failed:
                lines += wrapped(f"{outcome.take}: {outcome.error}", 2, terminal_columns())
        return "\n".join([*lines, "Summary:", *(f"  {file}" for file in self.files)])

    def _take_line(self, outcome: Outcome) -> str:
        count = len(self._names) - self._counts[Status.WAITING]
        whole = str(len(self._names))
        line = f"[{count:{len(whole)}}/{whole}] {outcome.take:{self._width}}  {outcome.status.value}"
        if outcome.status is Status.FAILED:
            return f"{line}: {outcome.error}"
        if outcome.record is not None and outcome.record.confidence is not None:
            line += f"  confidence {outcome.record.confidence:.2f}"
        if outcome.status is Status.CONVERTED and outcome.seconds is not None:
            line += f"  {outcome.seconds:.1f} s"
        return line

    def _show_progress(self) -> None:
        count, failed = len(self._names), self._counts[Status.FAILED]
        words = f"{count - self._counts[Status.WAITING]} of {pluralize(count, 'take')}"
        self.console.overall(self._progress.fraction, f"{words}, {failed} failed" if failed else words)

    def _note_write_error(self, sentence: str) -> None:
        if sentence not in self.write_errors:
            self.write_errors.append(sentence)


def _frame_count(record: ConversionRecord | None) -> int | None:
    return None if record is None else record.frames
