"""A worker as its batch sees it: a child process that answers jobs with messages, or is lost."""

import asyncio
import signal
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from ..usage import program_name
from .protocol import LONGEST_BYTES, Done, Job, Message, Ready, Step, read_message

SCRIPT = Path(__file__).with_name("start_worker.py")
START_TIMEOUT_S = 300.0
HEARTBEAT_TIMEOUT_S = 1800.0
"""A worker that sends no message for so long will never end: its decoder or its disk hangs."""
TERMINATION_GRACE_S = 10.0
"""Time that a worker has to clean up after SIGTERM."""
STDERR_TAIL_BYTES = 2000
"""Kept of what a worker writes on standard error, to say why it ended."""


class WorkerLostError(Exception):
    """A worker has crashed, does not start or has stalled; the text says how, as part of a sentence."""


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
    """A running worker."""

    def __init__(self, process: Process, heartbeat_timeout_s: float) -> None:
        self._process = process
        self._heartbeat_timeout_s = heartbeat_timeout_s
        self._stderr_tail = b""
        self._draining = None if process.stderr is None else asyncio.create_task(self._drain_stderr())

    @classmethod
    async def start(cls, words: Sequence[str], debug: bool, heartbeat_timeout_s: float) -> "WorkerProcess":
        """Start a worker and wait until it is ready.

        Args:
            words: The command.
            debug: Whether its standard error is shown.
            heartbeat_timeout_s: Longest time between two messages [s].

        Raises:
            WorkerLostError: The worker does not start.
        """
        try:
            process = await asyncio.create_subprocess_exec(
                *words, stdin=PIPE, stdout=PIPE, stderr=None if debug else PIPE, limit=LONGEST_BYTES
            )
        except OSError as error:
            raise WorkerLostError(f"{words[0]}: cannot be run ({error.strerror or error})") from error
        worker = cls(process, heartbeat_timeout_s)
        try:
            while not isinstance(await worker._message(START_TIMEOUT_S), Ready):
                pass
        except WorkerLostError as lost:
            await worker.terminate()
            raise WorkerLostError(worker._last_line or str(lost)) from lost
        except asyncio.CancelledError:
            await worker.terminate()
            raise
        return worker

    async def convert(self, job: Job, step: Callable[[Step], None]) -> Done:
        """Let the worker run a job.

        Args:
            job: The take and its settings.
            step: Receives the progress.

        Raises:
            WorkerLostError: The worker ends before the job does, or sends nothing until the timeout.
        """
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(job.to_line())
            await self._process.stdin.drain()
        except OSError as error:
            raise WorkerLostError(await self._exit_description()) from error
        while True:
            message = await self._message(self._heartbeat_timeout_s)
            if isinstance(message, Done):
                return message
            if isinstance(message, Step):
                step(message)

    async def retire(self) -> None:
        """Close the input of an idle worker, at whose end it exits."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        await self._exited_within(TERMINATION_GRACE_S)
        await self.terminate()

    async def terminate(self) -> None:
        """End the worker: with SIGTERM, on which it cleans up, and after a grace period with SIGKILL."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        with suppress(ProcessLookupError):
            self._process.terminate()
        if not await self._exited_within(TERMINATION_GRACE_S):
            self.kill()
            await self._process.wait()
        if self._draining is not None:
            await self._draining

    def kill(self) -> None:
        """End the worker at once, without a clean-up."""
        with suppress(ProcessLookupError):
            self._process.kill()

    async def _message(self, timeout_s: float) -> Message | None:
        assert self._process.stdout is not None
        try:
            async with asyncio.timeout(timeout_s):  # wait_for of Python 3.11 may swallow a cancellation
                line = await self._process.stdout.readline()
        except TimeoutError as error:
            raise WorkerLostError(f"told of no progress for {timeout_s / 60.0:.3g} minutes") from error
        except ValueError as error:  # no end of a line within the limit
            raise WorkerLostError("answered what is no answer") from error
        if not line:
            raise WorkerLostError(await self._exit_description())
        return read_message(line)

    async def _exit_description(self) -> str:
        """How the worker ended, as part of a sentence."""
        if not await self._exited_within(TERMINATION_GRACE_S):
            return "fell silent"
        if self._draining is not None:
            await asyncio.wait([self._draining], timeout=TERMINATION_GRACE_S)
        status = self._process.returncode or 0
        if status >= 0:
            reason = f" ({self._last_line})" if self._last_line else ""
            return f"ended with exit status {status}{reason}"
        with suppress(ValueError):
            return f"was killed by {signal.Signals(-status).name}"
        return f"was killed by signal {-status}"

    @property
    def _last_line(self) -> str:
        """The last line on standard error, without the program's name."""
        lines = self._stderr_tail.decode("utf-8", "replace").strip().splitlines()
        return lines[-1].removeprefix(f"{program_name()}: ") if lines else ""

    async def _exited_within(self, timeout_s: float) -> bool:
        with suppress(TimeoutError):
            async with asyncio.timeout(timeout_s):
                await self._process.wait()
        return self._process.returncode is not None

    async def _drain_stderr(self) -> None:
        """Read standard error, so that the worker never blocks on a full pipe; keep its end."""
        assert self._process.stderr is not None
        while chunk := await self._process.stderr.read(STDERR_TAIL_BYTES):
            self._stderr_tail = (self._stderr_tail + chunk)[-STDERR_TAIL_BYTES:]
