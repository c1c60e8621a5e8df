"""`keymark character`: its arguments."""

import argparse
from pathlib import Path

from ..command import Command
from ..options import CHARACTER_HELP, MAP_HELP


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the character, a map to check, and where to write its map."""
    parser.add_argument("character", metavar="FILE[:OBJECT]", help=CHARACTER_HELP)
    parser.add_argument("--map", metavar="TITLE|FILE|auto|none", default="auto", help=MAP_HELP)
    parser.add_argument("--output", "-o", metavar="FILE", type=Path, help="write its character map there")
    parser.add_argument("--replace", action="store_true", help="replace what is there already")


def run(arguments: argparse.Namespace) -> None:
    """Show the character."""
    from ..use_cases.character import character_command

    character_command(arguments)


CHARACTER = Command(
    name="character",
    description=(
        "Opens a character, recognizes which bones play which role, and says how surely and what it doubts. "
        "With --map it checks that the map is for this character; with --output it writes the map, to be "
        "corrected, kept and shared. Nothing else is written. Needs Blender."
    ),
    add_arguments=add_arguments,
    run=run,
)
