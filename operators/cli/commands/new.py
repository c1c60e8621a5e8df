"""`keymark new`: its arguments."""

import argparse
from pathlib import Path

from ..command import Command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the folder of clips and the file to write."""
    parser.add_argument("shoot", metavar="SHOOT", type=Path, help="folder of clips")
    parser.add_argument(
        "--output", "-o", metavar="FILE", type=Path, help="where to write; by default SHOOT/shoot.json"
    )


def run(arguments: argparse.Namespace) -> None:
    """Write the shoot's description."""
    from ..use_cases.new import new_command

    new_command(arguments)


NEW = Command(
    name="new",
    summary="describe a folder of clips: write its shoot.json",
    description=(
        "Looks at the clips below a folder and writes shoot.json there, with what the clips tell filled in "
        "and comments on what a person must say, once for all clips: camera, actor, and markers if any. It "
        "also says what each clip's motion can be held against."
    ),
    add_arguments=add_arguments,
    run=run,
)
