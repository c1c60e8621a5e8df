"""What the folder of results says of every take of a shoot, whoever converted it and when."""

from pathlib import Path

from ...take.conversion_record import record_if_any
from ..shoot import Shoot, ShootTake
from .failures import read_failure
from .outcome import Outcome, Status


def gather_outcomes(shoot: Shoot, output: Path) -> list[Outcome]:
    """What became of every take as the folder of the results shows it, in the order of their names."""
    return [gathered(take, output) for take in shoot.takes]


def gathered(take: ShootTake, output: Path) -> Outcome:
    """What became of one take as the folder of the results shows it; its input is not looked at."""
    folder = output / take.name
    record = record_if_any(folder)
    failure = read_failure(output, take.name)
    if failure is not None:
        return Outcome(take.name, folder, Status.FAILED, record, failure.error)
    return Outcome(take.name, folder, Status.WAITING if record is None else Status.CONVERTED, record)
