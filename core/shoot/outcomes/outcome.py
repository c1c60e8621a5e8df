"""What became of one take of a shoot."""

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from ...take.conversion_record import ConversionRecord


class Status(StrEnum):
    """How far a take has come."""

    CONVERTED = "converted"
    UNCHANGED = "unchanged"
    """It was converted before, from the same input."""
    FAILED = "failed"
    WAITING = "waiting"
    """Its turn has not come, or was interrupted."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """What became of one take."""

    take: str
    """Its name in the shoot."""
    folder: Path
    """Where its results lie, or would."""
    status: Status
    record: ConversionRecord | None = None
    """Of the results in the folder, if there are any: of an earlier input where this run has failed."""
    error: str | None = None
    """Why it failed, in a sentence."""
    seconds: float | None = None
    """How long this run worked on it."""
