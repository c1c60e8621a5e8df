"""The process that converts takes for a batch, one after the other, until nobody tells it any more."""

import os
import signal
import sys
import time
from collections.abc import Callable
from types import FrameType
from typing import BinaryIO

import cv2

from ....core.errors import BusyError, InputError, KeymarkError, unexpected
from ....core.progress import Progress
from ....core.shoot.outcomes.failures import CONVERSION, CRASH, INPUT
from ..blender_silence import blender_silence
from ..console import JOB_SHARE, Console
from ..conversion.convert_take import convert_take
from ..conversion.skip_unchanged import convert_if_changed
from ..usage import UsageError
from ..version import version
from .machine_resources import resident_bytes
from .protocol import BUSY, CONVERTED, FAILED, UNCHANGED, Answer, Done, Job, Ready, Step, answer_line

BETWEEN_STEPS_S = 0.5
"""A batch is told no more often how far a job is."""


def run_worker() -> None:
    """Convert the takes told on standard input, a job a line, and answer on standard output."""
    ending = _Ending()
    signal.signal(signal.SIGTERM, ending.asked)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the batch, which ends its workers
    say = _speaker(_own_output(), ending)
    cv2.setNumThreads(1)  # the processors are shared by workers; one each does the most
    with blender_silence(debug=False):
        from ...bridge import result_files  # noqa: F401  Blender starts now, not in the first take's time
    say(Ready(version()))
    for line in sys.stdin.buffer:
        say(work(Job.from_line(line), say))


def work(job: Job, say: Callable[[Answer], None]) -> Done:
    """Convert one take, whatever happens.

    Args:
        job: The take and how.
        say: Learns of the progress.
    """
    started = time.perf_counter()
    try:
        description = job.take.describe()
        settings = job.take.settings(description, job.farther)
        unit = convert_take if job.again else convert_if_changed
        made = unit(description, job.folder, _Steps(say), settings, job.debug)
        result, error, kind = UNCHANGED if made is None else CONVERTED, None, None
    except BusyError as busy:
        result, error, kind = BUSY, str(busy), None
    except (InputError, UsageError) as wrong:
        result, error, kind = FAILED, str(wrong), INPUT
    except KeymarkError as failed:
        result, error, kind = FAILED, str(failed), CONVERSION
    except OSError as wrong:
        reason = wrong.strerror or wrong
        result, error, kind = FAILED, f"{job.take.place}: cannot be converted ({reason})", CONVERSION
    except Exception as unknown:
        what = unexpected(unknown)
        result, error, kind = FAILED, f"failed unexpectedly ({what}); convert --debug shows where", CRASH
    return Done(result, time.perf_counter() - started, error, kind, resident_bytes())


class _Steps(Console):
    """Tells the batch how far a job is."""

    def __init__(self, say: Callable[[Answer], None]) -> None:
        super().__init__(quiet=True, as_json=False)
        self._say = say
        self._fraction = 0.0
        self._said = -BETWEEN_STEPS_S

    def progress(self, progress: Progress) -> None:
        super().progress(progress)
        self._fraction = JOB_SHARE * progress.fraction
        now = time.monotonic()
        if now >= self._said + BETWEEN_STEPS_S:
            self._said = now
            self._say(Step(progress.stage, self._fraction))

    def stage(self, name: str) -> None:
        super().stage(name)
        self._say(Step(name, self._fraction))


def _own_output() -> BinaryIO:
    """Standard output for answers alone: whatever else is written there from now on goes nowhere."""
    sys.stdout.flush()
    own = os.fdopen(os.dup(1), "wb", buffering=0)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)
    return own


def _speaker(output: BinaryIO, ending: "_Ending") -> Callable[[Answer], None]:
    def say(answer: Answer) -> None:
        if ending.due:
            raise KeyboardInterrupt
        try:
            output.write(answer_line(answer))
        except OSError:  # the batch is gone: nobody waits for this take
            raise KeyboardInterrupt from None

    return say


class _Ending:
    """Whether the process has been asked to end: what it is in the middle of may swallow the interruption.

    Blender makes an error of its own of one that arrives while it runs an exporter.
    """

    due = False

    def asked(self, _signal: int, _frame: FrameType | None) -> None:
        self.due = True
        raise KeyboardInterrupt
