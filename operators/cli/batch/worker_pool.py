"""Several workers on one list of jobs: each takes the next when it is done; none costs another anything."""

import asyncio
import signal
from collections import deque
from collections.abc import Awaitable, Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from typing import Any, Protocol

from ....core.errors import ConversionError
from ....core.shoot.outcomes.failures import CRASH
from .protocol import BUSY, FAILED, Done, Job, Step
from .worker_process import WorkerLostError, WorkerProcess

TRIES = 2
"""A take whose worker is lost is tried once more, by a new one; a worker that does not start likewise."""
LARGEST_WORKER_BYTES = 2**30
"""A worker that holds more than this after a take is replaced by a new one."""
SHORTEST_WAIT_S, LONGEST_WAIT_S = 0.5, 10.0
"""Before a take that another process is at work on is asked for again."""


class Watcher(Protocol):
    """Who learns how a batch gets on."""

    def step(self, job: Job, step: Step) -> None:
        """A worker has come so far with a job."""

    def put_off(self, job: Job, reason: str) -> None:
        """A job comes last, to be tried once more."""

    def done(self, job: Job, done: Done) -> None:
        """A job has come to its end."""


@dataclass(eq=False)
class _Turn:
    job: Job
    losses: int = 0
    busy: int = 0


class Supervisor:
    """Gives jobs to workers until none is left."""

    def __init__(
        self, jobs: Sequence[Job], start: Callable[[], Awaitable[WorkerProcess]], watcher: Watcher
    ) -> None:
        """Take the jobs.

        Args:
            jobs: In the order in which they are given out.
            start: Starts a worker.
            watcher: Learns of progress and results.
        """
        self._turns = deque(_Turn(job) for job in jobs)
        self._start = start
        self._watcher = watcher
        self._workers: set[WorkerProcess] = set()
        self._wrong_start = ""

    def run(self, workers: int) -> None:
        """Do all jobs, so many at a time.

        Raises:
            KeyboardInterrupt: A person or the system wants the batch to end; all workers have.
            ConversionError: No worker starts.
        """
        try:
            asyncio.run(self._run(workers))
        except asyncio.CancelledError:
            raise KeyboardInterrupt from None
        if self._turns:
            raise ConversionError(f"no worker process starts: {self._wrong_start}")

    async def _run(self, workers: int) -> None:
        with self._interruptible():
            lanes = [asyncio.create_task(self._lane()) for _ in range(workers)]
            try:
                await asyncio.wait(lanes)
            finally:
                for lane in lanes:
                    lane.cancel()
                await asyncio.wait(lanes)
            for lane in lanes:
                lane.result()

    async def _lane(self) -> None:
        """One worker after the other, each for as many jobs as it lives."""
        worker: WorkerProcess | None = None
        try:
            while turn := await self._next():
                if worker is None:
                    worker = await self._new_worker()
                if worker is None:
                    self._turns.appendleft(turn)
                    return
                if not await self._give(worker, turn):
                    await self._let_go(worker)
                    worker = None
            if worker is not None:
                await worker.retire()
        finally:
            if worker is not None:
                await self._let_go(worker)

    async def _next(self) -> _Turn | None:
        """The next turn; where only such are left that others are at work on, after a while."""
        free = next((turn for turn in self._turns if not turn.busy), None)
        if free is not None:
            self._turns.remove(free)
            return free
        if not self._turns:
            return None
        turn = self._turns.popleft()
        try:
            await asyncio.sleep(min(SHORTEST_WAIT_S * 2.0 ** min(turn.busy - 1, 10), LONGEST_WAIT_S))
        except asyncio.CancelledError:
            self._turns.append(turn)
            raise
        return turn

    async def _give(self, worker: WorkerProcess, turn: _Turn) -> bool:
        """Let a worker do a turn; returns whether the worker is good for another."""
        try:
            done = await worker.convert(turn.job, lambda step: self._watcher.step(turn.job, step))
        except WorkerLostError as lost:
            turn.losses += 1
            if turn.losses < TRIES:
                self._turns.append(turn)
                self._watcher.put_off(
                    turn.job, f"the process that converted it {lost}; it is tried once more"
                )
            else:
                error = f"the process that converted it {lost}, and so did the one that tried again"
                self._watcher.done(turn.job, Done(FAILED, error=error, kind=CRASH))
            return False
        if done.result == BUSY:
            if not turn.busy:
                self._watcher.put_off(turn.job, f"{done.error}; it is waited for")
            turn.busy += 1
            turn.job = replace(turn.job, again=False)  # what the other leaves is new enough
            self._turns.append(turn)
        else:
            self._watcher.done(turn.job, done)
        return (done.memory_bytes or 0) <= LARGEST_WORKER_BYTES

    async def _new_worker(self) -> WorkerProcess | None:
        for _ in range(TRIES):
            try:
                worker = await self._start()
            except WorkerLostError as lost:
                self._wrong_start = str(lost)
            else:
                self._workers.add(worker)
                return worker
        return None

    async def _let_go(self, worker: WorkerProcess) -> None:
        await worker.end()
        self._workers.discard(worker)

    @contextmanager
    def _interruptible(self) -> Iterator[None]:
        """Let Ctrl-C and a polite request to end stop the work at the next moment; a second one at once."""
        task = asyncio.current_task()
        assert task is not None
        asked = False

        def interrupt() -> None:
            nonlocal asked
            if asked:
                for worker in self._workers:
                    worker.kill()
            asked = True
            task.cancel()

        loop = asyncio.get_running_loop()
        before: list[tuple[signal.Signals, Any]] = []
        for wanted in (signal.SIGINT, signal.SIGTERM):
            # Not on Windows, and not off the main thread: there asyncio and the caller have their own ways.
            with suppress(NotImplementedError, RuntimeError, ValueError):
                handler = signal.getsignal(wanted)
                loop.add_signal_handler(wanted, interrupt)
                before.append((wanted, signal.SIG_DFL if handler is None else handler))
        try:
            yield
        finally:
            for wanted, handler in before:
                loop.remove_signal_handler(wanted)
                signal.signal(wanted, handler)
