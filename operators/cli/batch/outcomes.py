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
from ....core.shoot import outcomes
from ....core.shoot.discovery import Shoot
from ....core.shoot.outcomes import CONVERSION, Failure, Outcome, Status
from ....core.take.conversion_record import RECORD_FILE as RECORD
from ....core.take.conversion_record import find_record
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
    record = current_record(outcome)
    evidence = None if record is None else record.evidence
    fields = {
        "take": outcome.take,
        "status": outcome.status.value,
        "error": outcome.error,
        "seconds": None if outcome.seconds is None else round(outcome.seconds, 3),
        **{name: None if record is None else getattr(record, name) for name in RECORDED},
        "evidence": None if evidence is None else evidence.to_json(),
    }
    path = relative_path(outcome.folder, output)
    names = () if record is None else (*record.files, RECORD)
    return {**fields, "files": [name if path == "." else f"{path}/{name}" for name in names]}


def share_done(done: Sequence[float], frames: Sequence[int | None]) -> float:
    """The share of all work that is done, by that of each take and its length, the others' mean if None."""
    known = [count for count in frames if count is not None]
    mean = sum(known) / len(known) if known else 1.0
    lengths = [mean if count is None else count for count in frames]
    return sum(map(mul, done, lengths)) / sum(lengths) if lengths else 1.0


SHORTEST_SUMMARY_INTERVAL_S = 5.0
SUMMARY_SHARE = 0.1
"""Largest share of a batch's time that writing summaries takes, however many takes there are."""


class BatchOutcomes:
    """Receives the events of a worker pool; counts, shows and stores the outcomes of the takes."""

    def __init__(self, shoot: Shoot, output: Path, jobs: Sequence[Job], console: Console) -> None:
        """Begin with the outcomes that the folder has of all takes."""
        self.shoot, self.output, self.console = shoot, output, console
        self._outcomes = {take.name: outcomes.read_outcome(take, output) for take in shoot.takes}
        self._done = {job.take.name: 0.0 for job in jobs}
        """Of each take that is converted here, in the order of the jobs: how much of it is done, 0 to 1."""
        for name in self._done:
            self._outcomes[name] = replace(self._outcomes[name], status=Status.WAITING, error=None)
        self._width = min(max(map(len, self._done), default=0), 40)
        self._next_summary = time.monotonic()
        self.files: tuple[Path, ...] = ()
        self.write_errors: dict[str, None] = {}
        """Sentences on summaries and failures that could not be written, each once."""
        outcomes.remove_failures_of_deleted_takes(output, shoot)
        self._show_progress()

    @property
    def own_outcomes(self) -> list[Outcome]:
        """Outcomes of the takes that are converted here, in the order of the jobs."""
        return [self._outcomes[name] for name in self._done]

    @property
    def counts(self) -> dict[str, int]:
        counts = Counter(outcome.status for outcome in self.own_outcomes)
        return {status.value: counts[status] for status in Status}

    def job_progressed(self, job: Job, step: Step) -> None:
        self._done[job.take.name] = step.fraction
        self._show_progress()

    def job_requeued(self, job: Job, reason: str) -> None:
        """Say why a take is retried later."""
        self._done[job.take.name] = 0.0
        self.console.take_line(f"{job.take.name}: {reason}", None)

    def job_finished(self, job: Job, done: Done) -> None:
        """Store and show the outcome of a take; write a summary from time to time."""
        name, record = job.take.name, find_record(job.folder)
        self._done[name] = 1.0
        if done.result == FAILED:
            try:
                outcomes.write_failure(
                    self.output, Failure(name, done.error or "failed", done.kind or CONVERSION)
                )
            except KeymarkError as error:
                self.write_errors[str(error)] = None
        else:
            outcomes.remove_failure(self.output, name)
        outcome = Outcome(name, job.folder, Status(done.result), record, done.error, done.seconds)
        self._outcomes[name] = outcome
        whole = len(self._done)
        ended = f"[{whole - self.counts['waiting']:{len(str(whole))}}/{whole}]"
        line = f"{ended} {name:{self._width}}  {outcome.status.value}"
        if outcome.status is Status.FAILED:
            line += f": {outcome.error}"
        elif record is not None and record.confidence is not None:
            line += f"  confidence {record.confidence:.2f}"
        if outcome.status is Status.CONVERTED:
            line += f"  {done.seconds:.1f} s"
        self.console.take_line(line, outcome.error and f"{name}: {outcome.error}")
        self._show_progress()
        if time.monotonic() >= self._next_summary:
            self.summarize()

    def finish(self) -> None:
        """Write the final summary, with the outcomes that other machines have left meanwhile."""
        elsewhere = [take for take in self.shoot.takes if take.name not in self._done]
        before = None
        # Another machine may have finished, and written its own summary, while this one was written: without
        # a second look the summary that stays would lack the last take of that machine.
        while True:
            found = {take.name: outcomes.read_outcome(take, self.output) for take in elsewhere}
            shown = [(outcome.status, outcome.error, outcome.record) for outcome in found.values()]
            if shown == before:
                return
            before = shown
            self._outcomes |= found
            self.summarize()

    def summarize(self) -> None:
        started = time.monotonic()
        try:
            self.files = write_summary(self.output, self.shoot, list(self._outcomes.values()))
        except KeymarkError as error:
            self.write_errors[str(error)] = None
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
        lines = [f"{pluralize(len(self._done), 'take')}: {counts}.", *["Failed:"] * bool(failed)]
        for outcome in failed:
            lines += wrapped(f"{outcome.take}: {outcome.error}", 2, terminal_columns())
        return "\n".join([*lines, "Summary:", *(f"  {file}" for file in self.files)])

    def _show_progress(self) -> None:
        counts, own = self.counts, self.own_outcomes
        words = f"{len(own) - counts['waiting']} of {pluralize(len(own), 'take')}"
        frames = [None if outcome.record is None else outcome.record.frames for outcome in own]
        done = share_done(list(self._done.values()), frames)
        self.console.overall(done, f"{words}, {counts['failed']} failed" if counts["failed"] else words)
