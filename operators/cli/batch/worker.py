"""The worker process of a batch: converts jobs from standard input until end of file."""

import os
import signal
import sys
import time
from collections.abc import Callable

import cv2

from ....core.errors import BusyError, InputError, KeymarkError, describe_unexpected
from ....core.progress import Progress
from ....core.shoot.outcomes import CONVERSION, CRASH, INPUT
from ....core.take.description import effective_settings
from ..blender_silence import blender_silence
from ..console import JOB_SHARE, Console, UsageError
from ..conversion.convert_take import UpToDate, convert_take
from .machine_resources import resident_bytes
from .worker_process import BUSY, CONVERTED, FAILED, UNCHANGED, Done, Job, Message, Step, message_line


def run_worker() -> None:
    """Convert the jobs on standard input, one a line, and write messages on standard output."""
    send = _Sender()
    signal.signal(signal.SIGTERM, send.interrupt)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the batch, which ends its workers
    cv2.setNumThreads(1)  # the workers share the processors; one thread each is fastest
    with blender_silence(debug=False):
        from ...bridge import result_files  # noqa: F401  starts Blender before the first take is timed
    send(Step())
    for line in sys.stdin.buffer:
        send(run_job(Job.from_line(line), send))


def run_job(job: Job, send: Callable[[Message], None]) -> Done:
    """Convert one take; an error becomes part of the message."""
    started = time.perf_counter()
    how: tuple[str, ...]
    try:
        description = job.take.describe()
        settings = effective_settings(description, job.defaults)
        console = _JobConsole(send)
        convert_take(description, job.folder, console, settings, job.debug, again=job.again)
        how = (CONVERTED,)
    except UpToDate:
        how = (UNCHANGED,)
    except BusyError as busy:
        how = BUSY, str(busy)
    except (InputError, UsageError) as wrong:
        how = FAILED, str(wrong), INPUT
    except KeymarkError as failed:
        how = FAILED, str(failed), CONVERSION
    except OSError as wrong:
        how = FAILED, f"{job.take.path}: cannot be converted ({wrong.strerror or wrong})", CONVERSION
    except Exception as unknown:
        what = describe_unexpected(unknown)
        how = FAILED, f"failed unexpectedly ({what}); convert --debug shows where", CRASH
    return Done(*how, seconds=time.perf_counter() - started, memory_bytes=resident_bytes())


class _JobConsole(Console):
    """Sends the progress of a job to the batch, twice a second at most, and each new stage."""

    def __init__(self, send: Callable[[Message], None]) -> None:
        super().__init__(quiet=True, as_json=False)
        self._send = send
        self._fraction, self._next = 0.0, 0.0

    def progress(self, progress: Progress) -> None:
        super().progress(progress)
        self._fraction = JOB_SHARE * progress.fraction
        if time.monotonic() >= self._next:
            self._next = time.monotonic() + 0.5
            self._send(Step(progress.stage, self._fraction))

    def stage(self, name: str) -> None:
        super().stage(name)
        self._send(Step(name, self._fraction))


class _Sender:
    """Standard output for messages alone; it remembers SIGTERM, whose exception Blender may swallow."""

    def __init__(self) -> None:
        sys.stdout.flush()
        self._stream = os.fdopen(os.dup(1), "wb", buffering=0)
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 1)
        os.close(null)
        self._interrupted = False

    def __call__(self, message: Message) -> None:
        if self._interrupted:
            raise KeyboardInterrupt
        try:
            self._stream.write(message_line(message))
        except OSError:  # the batch is gone, and with it the reader of this message
            raise KeyboardInterrupt from None

    def interrupt(self, *_signal: object) -> None:
        self._interrupted = True
        raise KeyboardInterrupt
