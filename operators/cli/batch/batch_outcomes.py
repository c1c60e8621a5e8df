"""What is known of a batch's takes while it runs: told to the person, kept for the morning."""

import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ....core.errors import KeymarkError
from ....core.shoot.outcomes.failures import (
    CONVERSION,
    Failure,
    clear_failure,
    forget_gone_takes,
    write_failure,
)
from ....core.shoot.outcomes.outcome import Outcome, Status
from ....core.shoot.outcomes.take_outcomes import gather_outcomes, gathered
from ....core.shoot.shoot import Shoot
from ....core.take.conversion_record import ConversionRecord, record_if_any
from ....core.text import counted
from ..console import Console
from ..line_wrapping import broken, terminal_columns
from .batch_progress import Share
from .protocol import FAILED, Done, Job, Step
from .summary import write_summary

BETWEEN_SUMMARIES_S = 5.0
SUMMARY_SHARE = 0.1
"""Of a batch's time the summary takes at most about so much, however many takes it has."""
WIDEST_NAME = 40


class Tally:
    """Counts what has become of the takes, says it, and keeps summary and failures in the folder."""

    def __init__(self, shoot: Shoot, output: Path, jobs: Sequence[Job], console: Console) -> None:
        """Begin with what the folder says of all takes.

        Args:
            shoot: All of it, whichever part is converted here.
            output: The folder of all results.
            jobs: What is converted here.
            console: Learns of every take that is done.
        """
        self.shoot, self.output, self.console = shoot, output, console
        self._names = [job.take.name for job in jobs]
        self._outcomes = {outcome.take: outcome for outcome in gather_outcomes(shoot, output)}
        for name in self._names:
            self._outcomes[name] = replace(self._outcomes[name], status=Status.WAITING, error=None)
        self._counts = Counter({Status.WAITING: len(jobs)})
        self._share = Share([_frames(self._outcomes[name].record) for name in self._names])
        self._places = {name: place for place, name in enumerate(self._names)}
        self._width = min(max(map(len, self._names), default=0), WIDEST_NAME)
        self._next_summary = time.monotonic()
        self.files: tuple[Path, ...] = ()
        """Of the summary."""
        self.wrong: list[str] = []
        """What of it all could not be written, in sentences."""
        forget_gone_takes(output, shoot)
        self._show()

    @property
    def outcomes(self) -> list[Outcome]:
        """What has become of the takes that are converted here, in the order of their names."""
        return [self._outcomes[name] for name in self._names]

    @property
    def counts(self) -> dict[str, int]:
        """How many of the takes that are converted here have come how far."""
        return {status.value: self._counts[status] for status in Status}

    def step(self, job: Job, step: Step) -> None:
        """A worker has come so far with a take."""
        self._share.come(self._places[job.take.name], step.fraction)
        self._show()

    def put_off(self, job: Job, reason: str) -> None:
        """A take comes last, to be tried once more."""
        self._share.come(self._places[job.take.name], 0.0)
        self.console.take(f"{job.take.name}: {reason}", None)

    def done(self, job: Job, done: Done) -> None:
        """A take has come to its end."""
        name, record = job.take.name, record_if_any(job.folder)
        self._share.come(self._places[name], 1.0, _frames(record))
        if done.result == FAILED:
            self._keep(Failure(name, done.error or "failed", done.kind or CONVERSION))
        else:
            clear_failure(self.output, name)
        outcome = Outcome(name, job.folder, Status(done.result), record, done.error, done.seconds)
        self._outcomes[name] = outcome
        self._counts.update({outcome.status: 1, Status.WAITING: -1})
        self.console.take(self._line(outcome), outcome.error and f"{name}: {outcome.error}")
        self._show()
        if time.monotonic() >= self._next_summary:
            self.summarize()

    def finish(self) -> None:
        """Write the summary for good, with what other machines have done meanwhile."""
        while True:
            others = self._others()
            self._outcomes |= others
            self.summarize()
            # Another machine may have come to its end while this summary was written, and have written its
            # own before: without a second look the summary that stays would lack its last take.
            after = self._others()
            if all(_known(after[name]) == _known(others[name]) for name in others):
                return

    def _others(self) -> dict[str, Outcome]:
        """What has become of the takes that are not converted here."""
        here = set(self._names)
        return {take.name: gathered(take, self.output) for take in self.shoot.takes if take.name not in here}

    def summarize(self) -> None:
        """Write the summary as far as it goes."""
        started = time.monotonic()
        try:
            self.files = write_summary(self.output, self.shoot, list(self._outcomes.values()))
        except KeymarkError as error:
            self._note(str(error))
        now = time.monotonic()
        self._next_summary = now + max(BETWEEN_SUMMARIES_S, (now - started) / SUMMARY_SHARE)

    def to_dict(self) -> dict[str, Any]:
        """What has become of the takes, for `--json`."""
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
                for outcome in self.outcomes
            ],
            "files": [str(file) for file in self.files],
        }

    def text(self) -> str:
        """What has become of the takes, in lines for a person, failures with their reasons."""
        counts = ", ".join(f"{count} {name}" for name, count in self.counts.items() if count)
        failed = [outcome for outcome in self.outcomes if outcome.status is Status.FAILED]
        lines = [f"{counted(len(self._names), 'take')}: {counts}."]
        if failed:
            lines.append("Failed:")
            for outcome in failed:
                lines += broken(f"{outcome.take}: {outcome.error}", 2, terminal_columns())
        return "\n".join([*lines, "Summary:", *(f"  {file}" for file in self.files)])

    def _line(self, outcome: Outcome) -> str:
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

    def _show(self) -> None:
        count, failed = len(self._names), self._counts[Status.FAILED]
        words = f"{count - self._counts[Status.WAITING]} of {counted(count, 'take')}"
        self.console.overall(self._share.value, f"{words}, {failed} failed" if failed else words)

    def _keep(self, failure: Failure) -> None:
        try:
            write_failure(self.output, failure)
        except KeymarkError as error:
            self._note(str(error))

    def _note(self, sentence: str) -> None:
        if sentence not in self.wrong:
            self.wrong.append(sentence)


def _known(outcome: Outcome) -> tuple[Status, str | None, ConversionRecord | None]:
    return outcome.status, outcome.error, outcome.record


def _frames(record: ConversionRecord | None) -> int | None:
    return None if record is None else record.frames
