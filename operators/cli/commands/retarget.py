"""`keymark retarget`: its arguments."""

import argparse
from pathlib import Path

from ..command import Command
from ..options import CHARACTER_HELP, MAP_HELP, add_retarget_options


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the motion, the character, where the result goes, and how it is made."""
    parser.add_argument(
        "motion",
        metavar="OUT|motion.json",
        type=Path,
        help="folder of a result, as convert writes it, or its motion",
    )
    parser.add_argument("--character", "-c", metavar="FILE[:OBJECT]", required=True, help=CHARACTER_HELP)
    parser.add_argument("--map", metavar="TITLE|FILE|auto|none", default="auto", help=MAP_HELP)
    parser.add_argument(
        "--output", "-o", metavar="DIR", type=Path, required=True, help="folder for the result, new or old"
    )
    parser.add_argument(
        "--format",
        metavar="bvh,fbx,glb,usd",
        default="",
        help="further files of the character with its motion, separated by commas",
    )
    add_retarget_options(parser)


def run(arguments: argparse.Namespace) -> None:
    """Put the motion onto the character."""
    from ..use_cases.retarget import retarget_command

    retarget_command(arguments)


RETARGET = Command(
    name="retarget",
    description=(
        "Puts the motion of a finished conversion onto a character. DIR then holds character.blend, the "
        "character with the motion as its Action in front of the camera that filmed it, and retarget.json, "
        "which says what was recognized, how surely, and how good the result is. DIR changes only once all "
        "files are complete. Needs Blender."
    ),
    add_arguments=add_arguments,
    run=run,
)
