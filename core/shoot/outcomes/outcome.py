"""Outcomes of takes: converted, unchanged, failed or waiting; read from the folder of the results."""

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from ...take.conversion_record import ConversionRecord, find_record
from ..shoot import Shoot, ShootTake
from .failures import read_failure


class Status(StrEnum):
    """Status of a take in a batch."""

    CONVERTED = "converted"
    UNCHANGED = "unchanged"
    """Converted before, from the same input."""
    FAILED = "failed"
    WAITING = "waiting"
    """Not converted yet, or interrupted."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """The outcome of one take."""

    take: str
    """Its name in the shoot."""
    folder: Path
    """The folder of its results, which may not exist."""
    status: Status
    record: ConversionRecord | None = None
    """Of the results in the folder, if there are any: of an earlier input where this run has failed."""
    error: str | None = None
    """Why it failed, in a sentence."""
    seconds: float | None = None
    """Duration of its conversion in this run."""


def read_outcomes(shoot: Shoot, output: Path) -> list[Outcome]:
    """The outcome of every take as the folder of the results shows it, in the order of their names."""
    return [read_outcome(take, output) for take in shoot.takes]


def read_outcome(take: ShootTake, output: Path) -> Outcome:
    """The outcome of one take as the folder of the results shows it; its input is not looked at."""
    folder = output / take.name
    record = find_record(folder)
    failure = read_failure(output, take.name)
    if failure is not None:
        return Outcome(take.name, folder, Status.FAILED, record, failure.error)
    return Outcome(take.name, folder, Status.WAITING if record is None else Status.CONVERTED, record)
