"""A pool of worker processes on one job queue: each takes the next job when it is done with its last.

A job is retried where its worker crashes or stalls, and where another process holds the take's results.
"""

import signal
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from math import inf
from queue import Empty
from time import monotonic
from types import FrameType

from ....core.errors import ConversionError
from ....core.shoot.outcomes import CRASH
from .outcomes import BatchOutcomes
from .worker_process import BUSY, FAILED, START_TIMEOUT_S, Done, Events, Job, Message, Step, WorkerProcess

MOST_ATTEMPTS = 2
"""A job whose worker is lost is retried once, by a new worker; the start of a worker likewise."""
LARGEST_WORKER_BYTES = 2**30
"""A worker that holds more memory than this after a job is replaced by a new one."""
SHORTEST_BACKOFF_S, LONGEST_BACKOFF_S = 0.5, 10.0
"""Wait before the retry of a job that another process is at work on; it doubles with each retry."""


@dataclass(eq=False)
class _QueuedJob:
    job: Job
    lost_workers: int = 0
    busy_answers: int = 0
    not_before: float = 0.0


class WorkerPool:
    """Hands jobs to worker processes until the queue is empty."""

    def __init__(
        self,
        jobs: Sequence[Job],
        words: Sequence[str],
        outcomes: BatchOutcomes,
        heartbeat_timeout_s: float,
        debug: bool,
    ) -> None:
        self._queue = deque(map(_QueuedJob, jobs))
        self._words, self._debug, self._outcomes = words, debug, outcomes
        self._heartbeat_timeout_s = heartbeat_timeout_s
        self._events: Events = Events()
        self._workers: dict[WorkerProcess, _QueuedJob | None] = {}
        self._start_errors: list[str] = []
        """Why the last starts of workers have failed."""

    def run(self, workers: int) -> None:
        """Run all jobs, as many at a time as there are workers."""
        with self._interruptible():
            try:
                while self._queue or any(self._workers.values()):
                    self._employ(workers)
                    self._take_event()
                for worker in self._workers:
                    worker.close()
            except BaseException:
                for worker in self._workers:
                    worker.terminate()
                raise
            finally:
                for worker in self._workers:
                    worker.wait()

    def _employ(self, most: int) -> None:
        """Give idle workers the next jobs, those that others hold last, and start workers for those left."""
        for worker, current in self._workers.items():
            if current is None and worker.started and self._queue:
                free = (each for each in self._queue if not each.busy_answers)
                queued = next(free, None) or min(self._queue, key=lambda each: each.not_before)
                if queued.not_before > monotonic():
                    break
                self._queue.remove(queued)
                self._workers[worker] = queued
                worker.deadline = monotonic() + self._heartbeat_timeout_s
                worker.send(queued.job)
        idle = sum(job is None for job in self._workers.values())
        for _ in range(min(most - len(self._workers), len(self._queue) - idle)):
            if len(self._start_errors) >= MOST_ATTEMPTS:
                break
            try:
                self._workers[WorkerProcess(self._words, self._debug, self._events)] = None
            except OSError as error:
                self._start_errors.append(f"{self._words[0]}: cannot be run ({error.strerror or error})")
        if self._queue and not self._workers and len(self._start_errors) >= MOST_ATTEMPTS:
            raise ConversionError(f"no worker process starts: {self._start_errors[-1]}")

    def _take_event(self) -> None:
        moments = [worker.deadline for worker in self._workers]
        if any(worker.started and job is None for worker, job in self._workers.items()):
            moments += [queued.not_before for queued in self._queue]
        wait_s = min(moments, default=0.0) - monotonic()
        with suppress(Empty):  # within a second: on Windows no signal is handled meanwhile
            event = self._events.get(timeout=min(max(wait_s, 0.0), 1.0))
            if event is None:
                raise KeyboardInterrupt
            worker, message = event
            if worker in self._workers:  # else it was given up
                self._handle(worker, message)
        now = monotonic()
        for worker in [each for each in self._workers if each.deadline < now]:
            silent_s = self._heartbeat_timeout_s if worker.started else START_TIMEOUT_S
            self._lose(worker, f"told of no progress for {silent_s / 60.0:.3g} minutes")

    def _handle(self, worker: WorkerProcess, message: Message | None) -> None:
        if message is None:
            self._lose(worker, worker.exit_description())
            return
        worker.started = True
        self._start_errors.clear()
        queued = self._workers[worker]
        if queued is None:
            worker.deadline = inf  # no message is due before the next job
        elif isinstance(message, Step):
            worker.deadline = monotonic() + self._heartbeat_timeout_s
            self._outcomes.job_progressed(queued.job, message)
        else:
            worker.deadline = inf
            self._workers[worker] = None
            self._finish(queued, message)
            if (message.memory_bytes or 0) > LARGEST_WORKER_BYTES:
                del self._workers[worker]
                worker.terminate()
                worker.wait()

    def _finish(self, queued: _QueuedJob, done: Done) -> None:
        if done.result != BUSY:
            self._outcomes.job_finished(queued.job, done)
            return
        if not queued.busy_answers:
            self._outcomes.job_requeued(queued.job, f"{done.error}; it is waited for")
        backoff_s = min(SHORTEST_BACKOFF_S * 2.0 ** min(queued.busy_answers, 10), LONGEST_BACKOFF_S)
        queued.not_before = monotonic() + backoff_s
        queued.busy_answers += 1
        queued.job = replace(queued.job, again=False)  # what the other process leaves is new enough
        self._queue.append(queued)

    def _lose(self, worker: WorkerProcess, how: str) -> None:
        queued = self._workers.pop(worker)
        if not worker.started:
            self._start_errors.append(worker.last_line() or how)
        worker.terminate()
        worker.wait()
        if queued is None:
            return
        queued.lost_workers += 1
        lost = f"the process that converted it {how}"
        if queued.lost_workers < MOST_ATTEMPTS:
            self._queue.append(queued)
            self._outcomes.job_requeued(queued.job, f"{lost}; it is tried once more")
        else:
            error = f"{lost}, and so did the one that tried again"
            self._outcomes.job_finished(queued.job, Done(FAILED, error, CRASH))

    @contextmanager
    def _interruptible(self) -> Iterator[None]:
        """Take SIGINT and SIGTERM as the next event, and kill the workers on a second one."""
        interrupted = False

        def interrupt(_signal: int, _frame: FrameType | None) -> None:
            nonlocal interrupted
            for worker in list(self._workers) if interrupted else ():
                worker.process.kill()
            interrupted = True
            self._events.put(None)

        before = {}
        with suppress(ValueError):  # not off the main thread: the caller handles signals there
            for wanted in (signal.SIGINT, signal.SIGTERM):
                before[wanted] = signal.signal(wanted, interrupt)
        try:
            yield
        finally:
            for wanted, handler in before.items():
                signal.signal(wanted, signal.SIG_DFL if handler is None else handler)
