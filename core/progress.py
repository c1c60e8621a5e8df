"""Jobs that yield their progress: the one form every long computation has."""

from collections.abc import Callable, Generator
from dataclasses import dataclass, replace
from typing import Any, Protocol, TypeVar

Result = TypeVar("Result")
Given = TypeVar("Given")
Shown = TypeVar("Shown")


class Postures(Protocol):
    """A batch of postures, as `body/posture` has them, for which jobs of every kind have no other use."""

    @property
    def batch(self) -> tuple[int, ...]:
        """Shape of the batch."""
        ...

    def __getitem__(self, index: Any) -> Any:
        """One posture, or a smaller batch."""
        ...


@dataclass(frozen=True, eq=False)
class Preview:
    """The motion of some frames as far as it is known, for whoever likes to watch."""

    first: int
    """The first of the frames, from 0 for the clip's first."""
    posture: Postures
    """A batch of their postures."""


@dataclass(frozen=True)
class Progress:
    """How far a running job is."""

    stage: str
    """What is being done, for a person: a short phrase."""
    fraction: float
    """Share of the whole job that is done, 0 to 1."""
    preview: Preview | None = None
    """What has just been estimated, where something has."""


Part = Generator[float | Preview, None, Result]
"""A part of a job that yields the fraction of it that is done, and previews."""

Job = Generator[Progress, None, Result]
"""A job that yields its progress and returns its result; closing it cancels it."""


def run(job: Generator[Given, None, Result], report: Callable[[Given], object] | None = None) -> Result:
    """Drive a job, or a part of one, to its end and return its result, passing each progress to `report`."""
    while True:
        try:
            progress = next(job)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        if report is not None:
            report(progress)


def within(stage: str, part: Part[Result], first: float, last: float) -> Job[Result]:
    """Run a part that yields its own fraction as the stretch `first` to `last` of a whole job."""
    fraction = first

    def progress(done: float | Preview) -> Progress:
        nonlocal fraction
        if isinstance(done, Preview):
            return Progress(stage, fraction, done)
        fraction = done
        return Progress(stage, fraction)

    return _changed(scaled(part, first, last), progress)


def stretch(job: Job[Result], first: float, last: float) -> Job[Result]:
    """Run a job as the stretch `first` to `last` of a longer one."""
    return _changed(job, lambda done: replace(done, fraction=first + (last - first) * done.fraction))


def scaled(part: Generator[float | Preview | None, None, Result], first: float, last: float) -> Part[Result]:
    """Run a part as the stretch `first` to `last`; one that only says that it still runs stays at `first`."""

    def share(done: float | Preview | None) -> float | Preview:
        if isinstance(done, Preview):
            return done
        return first if done is None else first + (last - first) * done

    return _changed(part, share)


def _changed(
    part: Generator[Given, None, Result], change: Callable[[Given], Shown]
) -> Generator[Shown, None, Result]:
    """Run a generator with each thing it yields changed; returns its result."""
    while True:
        try:
            given = next(part)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        yield change(given)
