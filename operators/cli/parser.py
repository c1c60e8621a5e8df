"""Words of the command line: commands, options, and their help."""

import argparse
from pathlib import Path

from ...core.take.methods import METHODS
from .library.arguments import add_library
from .line_parser import Commands, LineParser, UsageError, add_command, program_name
from .shoot_arguments import add_shoot_commands
from .version import version

DESCRIPTION = "Turns one video of a performer wearing colored markers into an animated armature."
EXAMPLES = """\
examples:
  {program} demo
  {program} convert takes/walk --output out/walk
  {program} convert takes/walk --output out/walk --keyframes posed.json --method ekf --json
  {program} convert takes/walk --output out/walk --library walking --floor 0
  {program} new shoot
  {program} check shoot
  {program} batch shoot --output out --jobs 4
  {program} merge out --output library.blend
  {program} propose takes/walk --count 12
  {program} library list

A take is a folder with take.json, the clip and keyframes.json, or a clip below a shoot.json, which tells of
many; a library takes the place of keyframes.
Exit status: 0 done, 1 the conversion failed, 2 the input or the command line is unusable."""


def build_parser() -> argparse.ArgumentParser:
    """The parser; its result has `run`, the chosen command."""
    program = program_name()
    parser = LineParser(
        prog=program,
        description=DESCRIPTION,
        epilog=EXAMPLES.format(program=program),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"keymark {version()}")
    parser.set_defaults(run=_no_command)
    commands = parser.add_subparsers(metavar="COMMAND", title="commands")
    _add_convert(commands)
    add_shoot_commands(commands)
    _add_propose(commands)
    add_library(commands)
    _add_demo(commands)
    return parser


def _add_convert(commands: "Commands[LineParser]") -> None:
    convert = add_command(
        commands,
        "convert",
        "convert a take to motion.json, motion.blend, motion.bvh and pictures",
        "Reconstructs a take's motion. OUT then holds motion.json, motion.blend, motion.bvh and, in report/, "
        "pictures of the result; it changes only once all of them are complete. With --library nothing needs "
        "to be posed: TAKE/keyframes.json is left aside, and OUT gets the keyframes that were matched.",
        _convert,
    )
    convert.add_argument(
        "take", metavar="TAKE", type=Path, help="folder with take.json, or a clip of a shoot"
    )
    convert.add_argument(
        "--output", "-o", metavar="OUT", type=Path, required=True, help="folder for the result, new or old"
    )
    convert.add_argument(
        "--keyframes",
        metavar="FILE",
        type=Path,
        help="keyframe file; by default TAKE/keyframes.json, with --library none",
    )
    convert.add_argument(
        "--library",
        metavar="NAME|FILE|auto",
        help="match the footage with this keyframe library; auto chooses among all there are and says how "
        "sure it is, or that none fits",
    )
    convert.add_argument(
        "--floor",
        metavar="HEIGHT",
        type=float,
        help="height of the floor in meters where it is known, which says best how far away the performer "
        "is; with --library",
    )
    convert.add_argument(
        "--method",
        choices=METHODS,
        help="map: the whole clip at once (default); ekf: the filter of the paper; "
        "interpolation: the keyframes alone",
    )
    convert.add_argument("--no-report", action="store_true", help="draw no pictures")


def _add_propose(commands: "Commands[LineParser]") -> None:
    propose = add_command(
        commands,
        "propose",
        "propose the frames to pose",
        "Follows the markers and proposes frames to pose as keyframes: about evenly spaced, where the "
        "markers move slowly.",
        _propose,
    )
    propose.add_argument("take", metavar="TAKE", type=Path, help="take to pose, as in convert")
    propose.add_argument(
        "--count", metavar="N", type=int, help="number of keyframes; by default 10 per 100 frames"
    )
    propose.add_argument("--largest-gap", metavar="N", type=int, help="most frames between two keyframes")
    propose.add_argument("--picture", metavar="FILE", type=Path, help="write the speed plot there, a PNG")


def _add_demo(commands: "Commands[LineParser]") -> None:
    demo = add_command(
        commands,
        "demo",
        "convert the demonstration take and score the result",
        "Converts the take that comes with Keymark, whose true motion is known, and prints how far each "
        "method is from it.",
        _demo,
    )
    demo.add_argument(
        "--output",
        "-o",
        metavar="DIR",
        type=Path,
        default=Path("keymark_demo"),
        help="folder for the result (default: %(default)s)",
    )


# Commands are imported when they run: --help and mistakes shall not wait for scipy, OpenCV and Blender.


def _no_command(_arguments: argparse.Namespace) -> None:
    raise UsageError(
        "no command is given; convert, new, check, batch, merge, propose, library and demo are valid, see "
        f"{program_name()} --help"
    )


def _convert(arguments: argparse.Namespace) -> None:
    from .convert import convert_command

    convert_command(arguments)


def _propose(arguments: argparse.Namespace) -> None:
    from .propose import propose_command

    propose_command(arguments)


def _demo(arguments: argparse.Namespace) -> None:
    from .demo import demo_command

    demo_command(arguments)
