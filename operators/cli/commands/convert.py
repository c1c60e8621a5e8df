"""`keymark convert`: its arguments."""

import argparse
from pathlib import Path

from ....core.take.methods import METHODS
from ..command import Command
from .evidence_options import add_evidence, add_keypoint_files


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the take, where its result goes, and how it is converted."""
    parser.add_argument("take", metavar="TAKE", type=Path, help="folder with take.json, or a clip of a shoot")
    parser.add_argument(
        "--output", "-o", metavar="OUT", type=Path, required=True, help="folder for the result, new or old"
    )
    parser.add_argument(
        "--keyframes",
        metavar="FILE|auto",
        help="keyframe file, by default TAKE/keyframes.json; or auto: nothing needs to be posed, keyframes "
        "are found in the footage with all libraries there are",
    )
    add_keypoint_files(parser)
    add_evidence(parser)
    parser.add_argument(
        "--library",
        metavar="NAME|FILE|auto",
        help="find keyframes by matching the footage with this keyframe library alone; auto is --keyframes "
        "auto. --keyframes FILE beside it has posed keyframes, which stay",
    )
    parser.add_argument(
        "--floor",
        metavar="HEIGHT",
        type=float,
        help="height of the floor in meters where it is known, which says best how far away the performer "
        "is; where keyframes are found",
    )
    parser.add_argument(
        "--method",
        choices=METHODS,
        help="map: the whole clip at once (default); ekf: the filter of the paper; "
        "interpolation: the keyframes alone",
    )
    parser.add_argument("--no-report", action="store_true", help="draw no pictures")


def run(arguments: argparse.Namespace) -> None:
    """Convert the take."""
    from ..use_cases.convert import convert_command

    convert_command(arguments)


CONVERT = Command(
    name="convert",
    summary="convert a take to motion.json, motion.blend, motion.bvh and pictures",
    description=(
        "Reconstructs a take's motion. OUT then holds motion.json, motion.blend, motion.bvh and, in report/, "
        "pictures of the result; it changes only once all of them are complete. With --keyframes auto or "
        "--library nothing needs to be posed: TAKE/keyframes.json is left aside, and OUT gets the keyframes "
        "that were found."
    ),
    add_arguments=add_arguments,
    run=run,
)
