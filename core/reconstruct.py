"""The whole way from a take to a motion: one generator that the operator, command line and tests share."""

from collections.abc import Callable, Generator
from dataclasses import dataclass
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
