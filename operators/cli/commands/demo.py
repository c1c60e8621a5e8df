"""`keymark demo`: its arguments."""

import argparse
from pathlib import Path

from ..command import Command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the folder for the result."""
    parser.add_argument(
        "--output",
        "-o",
        metavar="DIR",
        type=Path,
        default=Path("keymark_demo"),
        help="folder for the result (default: %(default)s)",
    )


def run(arguments: argparse.Namespace) -> None:
    """Convert and score the demonstration take."""
    from ..use_cases.demo import demo_command

    demo_command(arguments)


DEMO = Command(
    name="demo",
    summary="convert the demonstration take and score the result",
    description=(
        "Converts the take that comes with Keymark, whose true motion is known, and prints how far each "
        "method is from it."
    ),
    add_arguments=add_arguments,
    run=run,
)
