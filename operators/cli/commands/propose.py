"""`keymark propose`: its arguments."""

import argparse
from pathlib import Path

from ..command import Command
from .evidence_options import add_evidence, add_keypoint_files


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the take, and how many frames of it to propose."""
    parser.add_argument("take", metavar="TAKE", type=Path, help="take to pose, as in convert")
    add_keypoint_files(parser)
    add_evidence(parser)
    parser.add_argument(
        "--count", metavar="N", type=int, help="number of keyframes; by default 10 per 100 frames"
    )
    parser.add_argument("--largest-gap", metavar="N", type=int, help="most frames between two keyframes")


def run(arguments: argparse.Namespace) -> None:
    """Propose the frames."""
    from ..use_cases.propose import propose_command

    propose_command(arguments)


PROPOSE = Command(
    name="propose",
    summary="propose the frames to pose",
    description=(
        "Follows the performer by markers or keypoints, else by what moves in the picture, and proposes "
        "frames to pose as keyframes: about evenly spaced, where the performer moves slowly."
    ),
    add_arguments=add_arguments,
    run=run,
)
