"""`keymark convert`: convert one take and report the result."""

import argparse
from dataclasses import replace
from pathlib import Path

from ....core.shoot.discovery import take_path
from ....core.take.conversion_settings import METHODS, ConversionSettings
from ....core.take.description import Description, describe, effective_settings
from ....core.take.evidence import KEYPOINTS
from ..console import arguments_console
from ..conversion.convert_take import conversion_summary, conversion_text, convert_take
from ..options import KEYPOINT_FILES, REFERENCE_FILE, evidence_option, given_settings, output
from ..parser import Command, UsageError, argument


def convert_command(arguments: argparse.Namespace) -> None:
    """Convert the take that the command line names, and list the files that were made."""
    with arguments_console(arguments) as console:
        console.stage("Reading the take")
        description = describe(take_path(arguments.take))
        settings = _settings(arguments, description)
        conversion = convert_take(description, arguments.output, console, settings, arguments.debug)
        console.finish(conversion_summary(conversion), conversion_text(conversion))


def _settings(arguments: argparse.Namespace, description: Description) -> ConversionSettings:
    """The settings of the command line, and else of the take.

    Where keyframes are to be found by the command line's word, only posed ones that it names count beside.
    """
    given = given_settings(arguments)
    settings = given.with_defaults(effective_settings(description))
    if given.floor_m is not None and settings.library is None:
        raise UsageError(
            "--floor is given without --keyframes auto or --library; the floor is asked for only where "
            "keyframes are found"
        )
    if given.keypoints and settings.evidence is not None and KEYPOINTS not in settings.evidence:
        raise UsageError(
            f"--keypoints is given, but the evidence is {', '.join(settings.evidence)} alone; name "
            f"{KEYPOINTS} in --evidence"
        )
    return settings if given.library is None else replace(settings, keyframes=given.keyframes)


CONVERT = Command(
    name="convert",
    description=(
        "Reconstructs a take's motion. OUT then holds motion.json, motion.blend, motion.bvh and, in report/, "
        "pictures of the result; it changes only once all of them are complete. With --keyframes auto or "
        "--library nothing needs to be posed: TAKE/keyframes.json is left aside, and OUT gets the keyframes "
        "that were found."
    ),
    arguments=(
        argument("take", metavar="TAKE", type=Path, help="folder with take.json, or a clip of a shoot"),
        *output("OUT", "folder for the result, new or old"),
        argument(
            "--keyframes",
            metavar="FILE|auto",
            help="keyframe file, by default TAKE/keyframes.json; or auto: nothing needs to be posed, "
            "keyframes are found in the footage with all libraries there are",
        ),
        KEYPOINT_FILES,
        REFERENCE_FILE,
        evidence_option(),
        argument(
            "--library",
            metavar="NAME|FILE|auto",
            help="find keyframes by matching the footage with this keyframe library alone; auto is "
            "--keyframes auto. --keyframes FILE beside it has posed keyframes, which stay",
        ),
        argument(
            "--floor",
            metavar="HEIGHT",
            type=float,
            help="height of the floor in meters where it is known, which says best how far away the "
            "performer is; where keyframes are found",
        ),
        argument(
            "--method",
            choices=METHODS,
            help="map: the whole clip at once (default); ekf: the filter of the paper; "
            "interpolation: the keyframes alone",
        ),
        argument("--no-report", action="store_true", help="draw no pictures"),
    ),
    run=convert_command,
)
