"""`keymark check`: its arguments."""

import argparse
from pathlib import Path

from ..command import Command
from .shoot_options import SHOOT_HELP, add_defaults


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the shoot and how its takes would be converted."""
    parser.add_argument("shoot", metavar="SHOOT", type=Path, help=f"{SHOOT_HELP}, or one take")
    parser.add_argument("--jobs", "-j", metavar="N", type=int, help="look at N takes at a time")
    add_defaults(parser)


def run(arguments: argparse.Namespace) -> None:
    """Look through the shoot."""
    from ..use_cases.check import check_command

    check_command(arguments)


CHECK = Command(
    name="check",
    summary="look through a shoot before it is converted",
    description=(
        "Reads everything a batch would read, samples frames of every clip, and says for each take whether "
        "it would convert, what it would be held against, how well its markers and keypoints are seen, and "
        "what is likely to go wrong. Nothing is written."
    ),
    add_arguments=add_arguments,
    run=run,
)
