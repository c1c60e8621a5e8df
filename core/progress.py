"""Jobs that yield their progress: the one form every long computation has."""

from collections.abc import Callable, Generator
from dataclasses import dataclass, replace
from typing import TypeVar

Result = TypeVar("Result")


@dataclass(frozen=True)
class Progress:
    """How far a running job is."""

    stage: str
    """What is being done, for a person: a short phrase."""
    fraction: float
    """Share of the whole job that is done, 0 to 1."""


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


def within(
    stage: str, part: Generator[float, None, Result], first: float, last: float
) -> Generator[Progress, None, Result]:
    """Run a part that yields its own fraction as the stretch `first` to `last` of a whole job."""
    while True:
        try:
            fraction = next(part)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        yield Progress(stage, first + (last - first) * fraction)


def stretch(job: Job[Result], first: float, last: float) -> Job[Result]:
    """Run a job as the stretch `first` to `last` of a longer one."""
    while True:
        try:
            progress = next(job)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        yield replace(progress, fraction=first + (last - first) * progress.fraction)
