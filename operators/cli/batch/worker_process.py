"""One worker as its batch sees it: a process that is told jobs and answers, or is lost."""

import asyncio
import signal
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from ..usage import program_name
from .protocol import LONGEST_BYTES, Answer, Done, Job, Ready, Step, read_answer

START = Path(__file__).with_name("start_worker.py")
LONGEST_START_S = 300.0
LONGEST_SILENCE_S = 1800.0
"""A worker that tells of no progress for so long will never end: its decoder or its disk hangs."""
GRACE_S = 10.0
"""What a worker that is asked to end gets to clean up."""
LAST_WORDS_BYTES = 2000


class WorkerLostError(Exception):
    """A worker came to an end by itself, or had to be ended; the text says how, as part of a sentence."""


def worker_words() -> list[str]:
    """The command that starts a worker in the same kind of process as this one."""
    blender = sys.modules.get("bpy")
    program = blender.app.binary_path if blender is not None else ""
    if not program:
        return [sys.executable, "-P", str(START)]
    words = sys.argv[1:]
    at = next((place for place, word in enumerate(words) if word in ("--command", "-c")), len(words))
    return [program, *words[:at], "--command", "keymark", "worker"]


class WorkerProcess:
    """A worker that has started and waits for jobs."""

    def __init__(self, process: Process, silence_s: float) -> None:
        self._process = process
        self._silence_s = silence_s
        self._last_words = b""
        self._listening = None if process.stderr is None else asyncio.create_task(self._listen())

    @classmethod
    async def started(cls, words: Sequence[str], debug: bool, silence_s: float) -> "WorkerProcess":
        """Start a worker and wait until it is ready.

        Args:
            words: The command.
            debug: Whether what it says on standard error is shown.
            silence_s: How long it may tell of no progress [s].

        Raises:
            WorkerLostError: It does not start.
        """
        try:
            process = await asyncio.create_subprocess_exec(
                *words, stdin=PIPE, stdout=PIPE, stderr=None if debug else PIPE, limit=LONGEST_BYTES
            )
        except OSError as error:
            raise WorkerLostError(f"{words[0]}: cannot be run ({error.strerror or error})") from error
        worker = cls(process, silence_s)
        try:
            while not isinstance(await worker._answer(LONGEST_START_S), Ready):
                pass
        except WorkerLostError as lost:
            await worker.end()
            raise WorkerLostError(worker._last_line or str(lost)) from lost
        except asyncio.CancelledError:
            await worker.end()
            raise
        return worker

    async def convert(self, job: Job, step: Callable[[Step], None]) -> Done:
        """Let it convert a take.

        Args:
            job: The take and how.
            step: Learns of the progress.

        Raises:
            WorkerLostError: It ends before it is done, or has nothing to tell for too long.
        """
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(job.to_line())
            await self._process.stdin.drain()
        except OSError as error:
            raise WorkerLostError(await self._end_of()) from error
        while True:
            answer = await self._answer(self._silence_s)
            if isinstance(answer, Done):
                return answer
            if isinstance(answer, Step):
                step(answer)

    async def retire(self) -> None:
        """End it when it has nothing to do."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        await self._gone(GRACE_S)
        await self.end()

    async def end(self) -> None:
        """End it, whatever it is doing: it is asked first, so that it can clean up."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        with suppress(ProcessLookupError):
            self._process.terminate()
        if not await self._gone(GRACE_S):
            self.kill()
            await self._process.wait()
        if self._listening is not None:
            await self._listening

    def kill(self) -> None:
        """End it at once."""
        with suppress(ProcessLookupError):
            self._process.kill()

    async def _answer(self, longest_s: float) -> Answer | None:
        assert self._process.stdout is not None
        try:
            async with asyncio.timeout(longest_s):  # wait_for of Python 3.11 may swallow a cancellation
                line = await self._process.stdout.readline()
        except TimeoutError as error:
            raise WorkerLostError(f"told of no progress for {longest_s / 60.0:.3g} minutes") from error
        except ValueError as error:  # no end of a line within the limit
            raise WorkerLostError("answered what is no answer") from error
        if not line:
            raise WorkerLostError(await self._end_of())
        return read_answer(line)

    async def _end_of(self) -> str:
        """How it ended."""
        if not await self._gone(GRACE_S):
            return "fell silent"
        if self._listening is not None:
            await asyncio.wait([self._listening], timeout=GRACE_S)
        status = self._process.returncode or 0
        if status >= 0:
            said = f" ({self._last_line})" if self._last_line else ""
            return f"ended with exit status {status}{said}"
        with suppress(ValueError):
            return f"was killed by {signal.Signals(-status).name}"
        return f"was killed by signal {-status}"

    @property
    def _last_line(self) -> str:
        """The last it said on standard error."""
        lines = self._last_words.decode("utf-8", "replace").strip().splitlines()
        return lines[-1].removeprefix(f"{program_name()}: ") if lines else ""

    async def _gone(self, within_s: float) -> bool:
        with suppress(TimeoutError):
            async with asyncio.timeout(within_s):
                await self._process.wait()
        return self._process.returncode is not None

    async def _listen(self) -> None:
        """Take what it says on standard error, so that it never waits; the last of it is kept."""
        assert self._process.stderr is not None
        while said := await self._process.stderr.read(LAST_WORDS_BYTES):
            self._last_words = (self._last_words + said)[-LAST_WORDS_BYTES:]
