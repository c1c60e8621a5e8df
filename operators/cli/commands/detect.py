"""`keymark detect`: its arguments."""

import argparse
from pathlib import Path

from ..command import Command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the clips, and where their keypoints go."""
    parser.add_argument(
        "target",
        metavar="CLIP|TAKE|SHOOT",
        type=Path,
        help="a clip, a take, a folder of takes, or a list of them (JSON Lines, .jsonl)",
    )
    parser.add_argument(
        "--output",
        "-o",
        metavar="FILE",
        type=Path,
        help="keypoint file of a single clip or take; by default keypoints.json in the take, or "
        "NAME.keypoints.json beside the clip",
    )
    parser.add_argument("--replace", action="store_true", help="replace keypoint files that are there")


def run(arguments: argparse.Namespace) -> None:
    """Detect the keypoints."""
    from ..use_cases.detect import detect_command

    detect_command(arguments)


DETECT = Command(
    name="detect",
    description=(
        "Finds 33 points of everybody in every frame, with a guess of their depth, by the network that comes "
        "with Keymark, and keeps them beside the clip, where converting uses them."
    ),
    add_arguments=add_arguments,
    run=run,
)
