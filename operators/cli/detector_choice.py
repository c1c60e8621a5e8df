"""The detector to use: that of an option, of the environment, or of the extension's preferences."""

import sys

from ...core.errors import InputError
from ..bridge.detector.detector_command import EXAMPLE, parse_command
from ..bridge.detector.detector_setting import DEFAULT_TIME_LIMIT_S, VARIABLE, Detector, environment_command
from .usage import UsageError

OPTION = "--detector"
LONGEST_TIME_LIMIT_MIN = 7.0 * 24.0 * 60.0


def chosen_detector(option: str | None, minutes: float | None) -> Detector:
    """The detector to use, the nearest setting first; its program is there.

    Args:
        option: What `--detector` gives; None or empty for nothing.
        minutes: What `--time-limit` gives.

    Raises:
        UsageError: The time limit is out of range.
        InputError: No detector is named, its command is unusable, or there is no such program.
    """
    if minutes is not None and not 0.0 < minutes <= LONGEST_TIME_LIMIT_MIN:
        raise UsageError(
            f"--time-limit is {minutes:g}; more than 0, at most {LONGEST_TIME_LIMIT_MIN:g} minutes are valid"
        )
    command = parse_command(option, OPTION) if option else environment_command()
    preferred = _preferred()
    if command is None and preferred is not None:
        command = preferred.command
    if command is None:
        raise InputError(
            f"no detector is named; valid is {OPTION} '{EXAMPLE}', the same in the variable {VARIABLE}, or "
            "in the extension's preferences"
        )
    command.check_program()
    if minutes is not None:
        return Detector(command, 60.0 * minutes)
    return Detector(command, DEFAULT_TIME_LIMIT_S if preferred is None else preferred.time_limit_s)


def _preferred() -> Detector | None:
    """What the preferences of a running Blender name."""
    if "bpy" not in sys.modules:
        return None
    from ..shell.preferences import preferred_detector

    return preferred_detector()
