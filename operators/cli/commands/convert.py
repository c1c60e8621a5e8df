"""`keymark convert`: convert one take and report the result."""

import argparse
from dataclasses import replace
from pathlib import Path

from ....core.shoot.discovery import take_path
from ....core.take.description import describe, effective_settings
from ....core.take.evidence import KEYPOINTS
from ..console import Console, UsageError, argument, command
from ..conversion.convert_take import conversion_summary, conversion_text, convert_take
from ..options import HANDS, PICTURES, SETTINGS, given_settings, output, setting_options


@command(
    argument("take TAKE", "folder with take.json, or a clip of a shoot", type=Path),
    *output("OUT", "folder for the result, new or old"),
    *setting_options(*SETTINGS),
    PICTURES,
    HANDS,
)
def convert_command(arguments: argparse.Namespace, console: Console) -> None:
    """Reconstructs a take's motion.

    OUT then holds motion.json, motion.blend, motion.bvh and, in report/, pictures of the result; it
    changes only once all of them are complete. With --keyframes auto or --library nothing needs to be
    posed: TAKE/keyframes.json is left aside, and OUT gets the keyframes that were found.
    """
    console.stage("Reading the take")
    description = describe(take_path(arguments.take))
    own = given_settings(arguments)
    settings = own.with_defaults(effective_settings(description))
    if own.floor_m is not None and settings.library is None:
        raise UsageError(
            "--floor is given without --keyframes auto or --library; the floor is asked for only where "
            "keyframes are found"
        )
    if own.keypoints and settings.evidence is not None and KEYPOINTS not in settings.evidence:
        raise UsageError(
            f"--keypoints is given, but the evidence is {', '.join(settings.evidence)} alone; name "
            f"{KEYPOINTS} in --evidence"
        )
    if own.library is not None:  # only posed ones that the command line names stand beside those found
        settings = replace(settings, keyframes=own.keyframes)
    conversion = convert_take(description, arguments.output, console, settings, arguments.debug)
    console.finish(conversion_summary(conversion), conversion_text(conversion))
    console.warn(conversion.warnings)
