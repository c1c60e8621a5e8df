"""The detector that the environment names, for the command line and for Blender alike."""

import os

from .detector_command import DetectorCommand, parse_command

VARIABLE = "KEYMARK_DETECTOR"


def environment_command() -> DetectorCommand | None:
    """The command in `KEYMARK_DETECTOR`; None where it is not set.

    Raises:
        InputError: It is unusable.
    """
    text = os.environ.get(VARIABLE, "")
    return parse_command(text, VARIABLE) if text.strip() else None
