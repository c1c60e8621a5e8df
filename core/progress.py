"""Jobs that yield their progress: the one form every long computation has."""

from collections.abc import Callable, Generator
from dataclasses import dataclass, replace
from typing import TypeVar

from .body.posture import Posture

Result = TypeVar("Result")


@dataclass(frozen=True, eq=False)
class Preview:
    """The motion of some frames as far as it is known, for whoever likes to watch."""

    first: int
    """The first of the frames, from 0 for the clip's first."""
    posture: Posture
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


def run(job: Job[Result], report: Callable[[Progress], None] | None = None) -> Result:
    """Drive a job to its end and return its result, passing each progress to `report`."""
    while True:
        try:
            progress = next(job)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        if report is not None:
            report(progress)


def finished(part: Generator[object, None, Result]) -> Result:
    """Drive any part of a job to its end at once, and return its result."""
    while True:
        try:
            next(part)
        except StopIteration as stop:
            result: Result = stop.value
            return result


def within(stage: str, part: Part[Result], first: float, last: float) -> Job[Result]:
    """Run a part that yields its own fraction as the stretch `first` to `last` of a whole job."""
    fraction = first
    while True:
        try:
            done = next(part)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        if isinstance(done, Preview):
            yield Progress(stage, fraction, done)
        else:
            fraction = first + (last - first) * done
            yield Progress(stage, fraction)


def stretch(job: Job[Result], first: float, last: float) -> Job[Result]:
    """Run a job as the stretch `first` to `last` of a longer one."""
    while True:
        try:
            progress = next(job)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        yield replace(progress, fraction=first + (last - first) * progress.fraction)
