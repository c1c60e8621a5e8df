"""Jobs: generators that yield their progress and return their result, for every long computation."""

from collections.abc import Callable, Generator
from dataclasses import dataclass, replace
from typing import Any, Protocol, TypeVar

Result = TypeVar("Result")
Yielded = TypeVar("Yielded")
Mapped = TypeVar("Mapped")


class Postures(Protocol):
    """A batch of postures, as in `body/posture`, which this module does not import."""

    @property
    def batch(self) -> tuple[int, ...]:
        """Shape of the batch."""
        ...

    def __getitem__(self, index: Any) -> Any:
        """One posture, or a smaller batch."""
        ...


@dataclass(frozen=True, eq=False)
class Preview:
    """The motion of some frames as estimated so far, for a live view."""

    first: int
    """Index of the first of these frames, 0 for the clip's first."""
    posture: Postures
    """Their postures, one batch."""


@dataclass(frozen=True)
class Progress:
    """Progress of a running job."""

    stage: str
    """Name of the current step, for a person: a short phrase."""
    fraction: float
    """Completed share of the whole job, 0 to 1."""
    preview: Preview | None = None
    """Frames that have just been estimated, if any."""


Part = Generator[float | Preview, None, Result]
"""A part of a job: yields its completed fraction and previews, returns its result."""

Job = Generator[Progress, None, Result]
"""A job: yields its progress and returns its result; closing it cancels it."""


def run(job: Generator[Yielded, None, Result], report: Callable[[Yielded], object] | None = None) -> Result:
    """Run a job, or a part of one, to its end; each progress is passed to `report`."""
    while True:
        try:
            progress = next(job)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        if report is not None:
            report(progress)


def within(stage: str, part: Part[Result], first: float, last: float) -> Job[Result]:
    """Turn a part into a job with one stage name; its progress runs from `first` to `last`."""
    fraction = first

    def progress(done: float | Preview) -> Progress:
        nonlocal fraction
        if isinstance(done, Preview):
            return Progress(stage, fraction, done)
        fraction = done
        return Progress(stage, fraction)

    return _map_progress(scaled(part, first, last), progress)


def stretch(job: Job[Result], first: float, last: float) -> Job[Result]:
    """Rescale a job's progress from 0 to 1 to `first` to `last` of a longer job."""
    return _map_progress(job, lambda done: replace(done, fraction=first + (last - first) * done.fraction))


def scaled(part: Generator[float | Preview | None, None, Result], first: float, last: float) -> Part[Result]:
    """Rescale a part's fraction to `first` to `last`; a part that yields None stays at `first`."""

    def rescale(done: float | Preview | None) -> float | Preview:
        if isinstance(done, Preview):
            return done
        return first if done is None else first + (last - first) * done

    return _map_progress(part, rescale)


def _map_progress(
    part: Generator[Yielded, None, Result], function: Callable[[Yielded], Mapped]
) -> Generator[Mapped, None, Result]:
    """Apply a function to every value that a generator yields; its result is returned."""
    while True:
        try:
            value = next(part)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        yield function(value)
