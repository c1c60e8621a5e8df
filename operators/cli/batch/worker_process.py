"""A worker as its batch sees it: a child process that answers jobs with messages, or is lost."""

import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from math import inf
from pathlib import Path
from queue import SimpleQueue

from ..usage import program_name
from .protocol import LONGEST_BYTES, Job, Message, read_message

SCRIPT = Path(__file__).with_name("start_worker.py")
START_TIMEOUT_S = 300.0
HEARTBEAT_TIMEOUT_S = 1800.0
"""A worker that sends no message for so long will never end: its decoder or its disk hangs."""
TERMINATION_GRACE_S = 10.0
"""Time that a worker has to clean up after SIGTERM."""
STDERR_TAIL_BYTES = 2000
"""Read of what a worker has written on standard error, to say why it ended."""


def worker_command_line() -> list[str]:
    """The command that starts a worker in the same kind of process as this one: Python or Blender."""
    blender = sys.modules.get("bpy")
    program = blender.app.binary_path if blender is not None else ""
    if not program:
        return [sys.executable, "-P", str(SCRIPT)]
    words = sys.argv[1:]
    own = next((index for index, word in enumerate(words) if word in ("--command", "-c")), len(words))
    return [program, *words[:own], "--command", "keymark", "worker"]


class WorkerProcess:
    """A running worker; a thread of its own reads its messages."""

    def __init__(self, words: Sequence[str], debug: bool, events: "Events") -> None:
        """Start a worker.

        Raises:
            OSError: There is no such program.
        """
        self.ready = self._asked_to_end = False
        self.deadline = time.monotonic() + START_TIMEOUT_S
        """When it is lost unless it sends a message before."""
        self._stderr = tempfile.TemporaryFile()
        try:
            self._process = subprocess.Popen(
                words,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=None if debug else self._stderr,
            )
        except OSError:
            self._stderr.close()
            raise
        self._reader = threading.Thread(target=self._read, args=(events,), daemon=True)
        self._reader.start()

    def _read(self, events: "Events") -> None:
        stream = self._process.stdout
        assert stream is not None
        with stream:
            while line := stream.readline(LONGEST_BYTES):
                message = read_message(line)
                if message is not None:
                    events.put((self, message))
        events.put((self, None))

    def send(self, job: Job) -> None:
        """Let the worker run a job; where it has ended, its end follows as an event."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.write(job.to_line())
            self._process.stdin.flush()

    def rest(self) -> None:
        """Expect no message until the next job."""
        self.ready, self.deadline = True, inf

    def close(self) -> None:
        """Close its input, at whose end an idle worker exits."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.close()

    def terminate(self) -> None:
        """Ask the worker to clean up and end."""
        self._asked_to_end = True
        self.close()
        self._process.terminate()

    def kill(self) -> None:
        """End the worker at once, without a clean-up."""
        self._process.kill()

    def wait(self) -> None:
        """Wait until it has ended; after a grace period it is asked to, after another one killed."""
        for end in [self.kill] if self._asked_to_end else [self.terminate, self.kill]:
            if self._has_ended_within(TERMINATION_GRACE_S):
                break
            end()
        self._process.wait()
        self._reader.join(TERMINATION_GRACE_S)
        self._stderr.close()

    def exit_description(self) -> str:
        """How the worker ended, as part of a sentence."""
        if not self._has_ended_within(TERMINATION_GRACE_S):
            return "fell silent"
        status = self._process.returncode
        if status >= 0:
            return f"ended with exit status {status}{f' ({self.last_line})' if self.last_line else ''}"
        with suppress(ValueError):
            return f"was killed by {signal.Signals(-status).name}"
        return f"was killed by signal {-status}"

    @property
    def last_line(self) -> str:
        """The last line on standard error, without the program's name."""
        self._stderr.seek(max(0, self._stderr.seek(0, 2) - STDERR_TAIL_BYTES))
        lines = self._stderr.read().decode("utf-8", "replace").strip().splitlines()
        return lines[-1].removeprefix(f"{program_name()}: ") if lines else ""

    def _has_ended_within(self, timeout_s: float) -> bool:
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(timeout_s)
        return self._process.returncode is not None


Events = SimpleQueue[tuple[WorkerProcess, Message | None] | None]
"""Messages of workers, None for the end of one; None alone where a signal asks the batch to end."""
