"""The worker process of a batch: converts jobs from standard input until end of file."""

import os
import signal
import sys
import time
from collections.abc import Callable
from types import FrameType
from typing import BinaryIO

import cv2

from ....core.errors import BusyError, InputError, KeymarkError, describe_unexpected
from ....core.progress import Progress
from ....core.shoot.outcomes import CONVERSION, CRASH, INPUT
from ..blender_silence import blender_silence
from ..command import UsageError
from ..console import JOB_SHARE, Console
from ..conversion.convert_take import convert_if_changed
from .machine_resources import resident_bytes
from .worker_process import BUSY, CONVERTED, FAILED, UNCHANGED, Done, Job, Message, Ready, Step, message_line

SHORTEST_STEP_S = 0.5
"""Shortest time between two messages on the progress of a job."""


def run_worker() -> None:
    """Convert the jobs on standard input, one a line, and write messages on standard output."""
    interruption = _Interruption()
    signal.signal(signal.SIGTERM, interruption.handle)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the batch, which ends its workers
    send = _sender(_message_stream(), interruption)
    cv2.setNumThreads(1)  # the workers share the processors; one thread each is fastest
    with blender_silence(debug=False):
        from ...bridge import result_files  # noqa: F401  starts Blender before the first take is timed
    send(Ready())
    for line in sys.stdin.buffer:
        send(run_job(Job.from_line(line), send))


def run_job(job: Job, send: Callable[[Message], None]) -> Done:
    """Convert one take; an error becomes part of the message."""
    started = time.perf_counter()
    try:
        description = job.take.describe()
        settings = job.take.settings(description, job.defaults)
        console = _JobConsole(send)
        made = convert_if_changed(description, job.folder, console, settings, job.debug, job.again)
        result, error, kind = UNCHANGED if made is None else CONVERTED, None, None
    except BusyError as busy:
        result, error, kind = BUSY, str(busy), None
    except (InputError, UsageError) as wrong:
        result, error, kind = FAILED, str(wrong), INPUT
    except KeymarkError as failed:
        result, error, kind = FAILED, str(failed), CONVERSION
    except OSError as wrong:
        reason = wrong.strerror or wrong
        result, error, kind = FAILED, f"{job.take.path}: cannot be converted ({reason})", CONVERSION
    except Exception as unknown:
        what = describe_unexpected(unknown)
        result, error, kind = FAILED, f"failed unexpectedly ({what}); convert --debug shows where", CRASH
    return Done(result, time.perf_counter() - started, error, kind, resident_bytes())


class _JobConsole(Console):
    """Sends the progress of a job to the batch."""

    def __init__(self, send: Callable[[Message], None]) -> None:
        super().__init__(quiet=True, as_json=False)
        self._send = send
        self._fraction = 0.0
        self._sent = -SHORTEST_STEP_S

    def progress(self, progress: Progress) -> None:
        super().progress(progress)
        self._fraction = JOB_SHARE * progress.fraction
        now = time.monotonic()
        if now >= self._sent + SHORTEST_STEP_S:
            self._sent = now
            self._send(Step(progress.stage, self._fraction))

    def stage(self, name: str) -> None:
        super().stage(name)
        self._send(Step(name, self._fraction))


def _message_stream() -> BinaryIO:
    """Standard output for messages alone: everything else written there from now on is discarded."""
    sys.stdout.flush()
    stream = os.fdopen(os.dup(1), "wb", buffering=0)
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 1)
    os.close(null)
    return stream


def _sender(stream: BinaryIO, interruption: "_Interruption") -> Callable[[Message], None]:
    def send(message: Message) -> None:
        if interruption.due:
            raise KeyboardInterrupt
        try:
            stream.write(message_line(message))
        except OSError:  # the batch is gone, and with it the reader of this message
            raise KeyboardInterrupt from None

    return send


class _Interruption:
    """Remembers that SIGTERM has arrived, for the code that it interrupts may swallow the exception.

    Blender turns a KeyboardInterrupt that arrives while it runs an exporter into an error of its own.
    """

    due = False

    def handle(self, _signal: int, _frame: FrameType | None) -> None:
        self.due = True
        raise KeyboardInterrupt
