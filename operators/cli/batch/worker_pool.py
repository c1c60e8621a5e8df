"""A pool of worker processes on one job queue: each takes the next job when it is done with its last.

A job is retried where its worker crashes or stalls, and where another process holds the take's results.
"""

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

MOST_ATTEMPTS = 2
"""A job whose worker is lost is retried once, by a new worker; the start of a worker likewise."""
LARGEST_WORKER_BYTES = 2**30
"""A worker that holds more memory than this after a job is replaced by a new one."""
SHORTEST_BACKOFF_S, LONGEST_BACKOFF_S = 0.5, 10.0
"""Wait before the retry of a job that another process is at work on; it doubles with each retry."""


class PoolListener(Protocol):
    """Receives the events of a pool."""

    def job_progressed(self, job: Job, step: Step) -> None:
        """A worker has progressed with a job."""

    def job_requeued(self, job: Job, reason: str) -> None:
        """A job goes to the end of the queue, to be retried."""

    def job_finished(self, job: Job, done: Done) -> None:
        """A job has ended."""


@dataclass(eq=False)
class _QueuedJob:
    job: Job
    lost_workers: int = 0
    busy_answers: int = 0


class WorkerPool:
    """Hands jobs to worker processes until the queue is empty."""

    def __init__(
        self, jobs: Sequence[Job], start: Callable[[], Awaitable[WorkerProcess]], listener: PoolListener
    ) -> None:
        """Queue the jobs.

        Args:
            jobs: In the order in which they are handed out.
            start: Starts a worker.
            listener: Receives progress and results.
        """
        self._queue = deque(_QueuedJob(job) for job in jobs)
        self._start = start
        self._listener = listener
        self._workers: set[WorkerProcess] = set()
        self._start_error = ""

    def run(self, workers: int) -> None:
        """Run all jobs, as many at a time as there are workers.

        Raises:
            KeyboardInterrupt: A signal asked the batch to end; all workers have ended.
            ConversionError: No worker starts.
        """
        try:
            asyncio.run(self._run(workers))
        except asyncio.CancelledError:
            raise KeyboardInterrupt from None
        if self._queue:
            raise ConversionError(f"no worker process starts: {self._start_error}")

    async def _run(self, workers: int) -> None:
        with self._interruptible():
            slots = [asyncio.create_task(self._worker_slot()) for _ in range(workers)]
            try:
                await asyncio.wait(slots)
            finally:
                for slot in slots:
                    slot.cancel()
                await asyncio.wait(slots)
            for slot in slots:
                slot.result()

    async def _worker_slot(self) -> None:
        """Run jobs in one worker after the other, each as long as it is good for another job."""
        worker: WorkerProcess | None = None
        try:
            while queued := await self._next():
                if worker is None:
                    worker = await self._new_worker()
                if worker is None:
                    self._queue.appendleft(queued)
                    return
                if not await self._run_job(worker, queued):
                    await self._discard(worker)
                    worker = None
            if worker is not None:
                await worker.retire()
        finally:
            if worker is not None:
                await self._discard(worker)

    async def _next(self) -> _QueuedJob | None:
        """Take the next job; where other processes hold all that are left, wait before the retry."""
        free = next((queued for queued in self._queue if not queued.busy_answers), None)
        if free is not None:
            self._queue.remove(free)
            return free
        if not self._queue:
            return None
        queued = self._queue.popleft()
        try:
            doublings = min(queued.busy_answers - 1, 10)
            await asyncio.sleep(min(SHORTEST_BACKOFF_S * 2.0**doublings, LONGEST_BACKOFF_S))
        except asyncio.CancelledError:
            self._queue.append(queued)
            raise
        return queued

    async def _run_job(self, worker: WorkerProcess, queued: _QueuedJob) -> bool:
        """Let a worker run a job; returns whether the worker is good for another."""
        try:
            done = await worker.convert(
                queued.job, lambda step: self._listener.job_progressed(queued.job, step)
            )
        except WorkerLostError as lost:
            self._retry_or_fail(queued, lost)
            return False
        if done.result == BUSY:
            if not queued.busy_answers:
                self._listener.job_requeued(queued.job, f"{done.error}; it is waited for")
            queued.busy_answers += 1
            queued.job = replace(queued.job, again=False)  # what the other process leaves is new enough
            self._queue.append(queued)
        else:
            self._listener.job_finished(queued.job, done)
        return (done.memory_bytes or 0) <= LARGEST_WORKER_BYTES

    def _retry_or_fail(self, queued: _QueuedJob, lost: WorkerLostError) -> None:
        queued.lost_workers += 1
        if queued.lost_workers < MOST_ATTEMPTS:
            self._queue.append(queued)
            self._listener.job_requeued(
                queued.job, f"the process that converted it {lost}; it is tried once more"
            )
        else:
            error = f"the process that converted it {lost}, and so did the one that tried again"
            self._listener.job_finished(queued.job, Done(FAILED, error=error, kind=CRASH))

    async def _new_worker(self) -> WorkerProcess | None:
        for _ in range(MOST_ATTEMPTS):
            try:
                worker = await self._start()
            except WorkerLostError as lost:
                self._start_error = str(lost)
            else:
                self._workers.add(worker)
                return worker
        return None

    async def _discard(self, worker: WorkerProcess) -> None:
        await worker.terminate()
        self._workers.discard(worker)

    @contextmanager
    def _interruptible(self) -> Iterator[None]:
        """Cancel the work on SIGINT and SIGTERM; a second signal kills the workers."""
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
            # Not on Windows, and not off the main thread: asyncio and the caller handle signals there.
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
