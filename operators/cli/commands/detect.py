"""`keymark detect`: its arguments."""

import argparse
from pathlib import Path

from ..command import Command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the clips, the detector, and where its keypoints go."""
    parser.add_argument(
        "target",
        metavar="CLIP|TAKE|SHOOT",
        type=Path,
        help="a clip, a take, a folder of takes, or a list of them (JSON Lines, .jsonl)",
    )
    parser.add_argument(
        "--detector",
        metavar="COMMAND",
        help="the program's command with {clip} and {output} in it; by default that of the variable "
        "KEYMARK_DETECTOR, or of the extension's preferences",
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
    parser.add_argument(
        "--time-limit",
        metavar="MINUTES",
        type=float,
        help="stop a detector that takes longer for one clip; 120 by default",
    )


def run(arguments: argparse.Namespace) -> None:
    """Detect the keypoints."""
    from ..use_cases.detect import detect_command

    detect_command(arguments)


DETECT = Command(
    name="detect",
    description=(
        "Calls a program of yours with each clip, reads the keypoints that it writes, checks them against "
        "the clip and keeps them beside it. The command is words with {clip}, {output}, {output_folder}, "
        "{width}, {height}, {fps}, {frames}, {frame_start} or {detectors} in them, or a JSON list of such "
        "words; no shell runs it. docs/detectors.md shows the commands of common detectors, and of one that "
        "comes with Keymark."
    ),
    add_arguments=add_arguments,
    run=run,
)
