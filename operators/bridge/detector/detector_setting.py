"""A detector as it is set: its command, its time limit, and the variable that may name it."""

import os
from dataclasses import dataclass

from .detector_command import DetectorCommand, parse_command

VARIABLE = "KEYMARK_DETECTOR"
DEFAULT_TIME_LIMIT_S = 2.0 * 3600.0
"""The longest clips take a network on a processor about this long."""


@dataclass(frozen=True)
class Detector:
    """A detector and how it is run."""

    command: DetectorCommand
    time_limit_s: float = DEFAULT_TIME_LIMIT_S


def environment_command() -> DetectorCommand | None:
    """The command in `KEYMARK_DETECTOR`; None where it is not set.

    Raises:
        InputError: It is unusable.
    """
    text = os.environ.get(VARIABLE, "")
    return parse_command(text, VARIABLE) if text.strip() else None
