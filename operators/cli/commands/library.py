"""`keymark library` with its commands: their arguments."""

import argparse
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from ..command import Command, CommandGroup

LIBRARY_HELP = "name or file of a library"


def _use_case(module: str, function: str) -> Callable[[argparse.Namespace], None]:
    """A command's function in `use_cases/library`, imported when it runs."""

    def run(arguments: argparse.Namespace) -> None:
        getattr(import_module(f"..use_cases.library.{module}", __package__), function)(arguments)

    return run


def _add_library(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("library", metavar="LIBRARY", help=LIBRARY_HELP)


def _add_output(parser: argparse.ArgumentParser, metavar: str, text: str) -> None:
    """Add where a command writes, and whether it may replace what is there."""
    parser.add_argument("--output", "-o", metavar=metavar, type=Path, required=True, help=text)
    parser.add_argument("--replace", action="store_true", help="replace what is there already")


def _add_library_file(parser: argparse.ArgumentParser) -> None:
    _add_output(parser, "FILE", "the new library file")


LIST = Command(
    name="list",
    summary="list the libraries that can be named",
    description="Lists the libraries that come with Keymark and those in the folders of KEYMARK_LIBRARIES.",
    run=_use_case("list_show_check", "list_command"),
)


def _add_show(parser: argparse.ArgumentParser) -> None:
    _add_library(parser)
    parser.add_argument("--sheet", metavar="FILE", type=Path, help="draw all its postures there, a PNG")


SHOW = Command(
    name="show",
    summary="say what a library holds",
    description="Says what a library holds, and draws it.",
    add_arguments=_add_show,
    run=_use_case("list_show_check", "show_command"),
)


def _add_check(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("files", metavar="FILE", type=Path, nargs="+", help="library files")


CHECK = Command(
    name="check",
    summary="check library files",
    description=(
        "Reads library files as strictly as Keymark always does and says what is wrong with each that is."
    ),
    add_arguments=_add_check,
    run=_use_case("list_show_check", "check_command"),
)


def _add_merge(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "library", metavar="A", help=f"{LIBRARY_HELP}, which gives title, author and proportions"
    )
    parser.add_argument("other", metavar="B", help=LIBRARY_HELP)
    parser.add_argument(
        "--conflicts",
        choices=("keep", "replace"),
        help="of two versions: what of A has changed in B is kept, or replaced; by default they are named "
        "and nothing is written",
    )
    parser.add_argument("--title", metavar="TEXT", help="of the new library; by default that of both")
    parser.add_argument(
        "--identifier", metavar="NAME", help="of the new library; by default made of the title"
    )
    _add_library_file(parser)


MERGE = Command(
    name="merge",
    summary="join two libraries",
    description=(
        "Writes the postures and motions of both libraries as one, on the proportions of the first. Two "
        "versions of one library are merged by name; different libraries become a new one, in which "
        "postures of the same name get a number."
    ),
    add_arguments=_add_merge,
    run=_use_case("learn_merge_mirror", "merge_command"),
)


def _add_mirror(parser: argparse.ArgumentParser) -> None:
    _add_library(parser)
    parser.add_argument(
        "--both", action="store_true", help="add the mirrored postures and motions that the library lacks"
    )
    _add_library_file(parser)


MIRROR = Command(
    name="mirror",
    summary="exchange left and right",
    description=(
        "Writes a library with left and right exchanged in every posture and motion. Matching does so by "
        "itself; it is for posing."
    ),
    add_arguments=_add_mirror,
    run=_use_case("learn_merge_mirror", "mirror_command"),
)


def _add_learn(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("motion", metavar="MOTION", type=Path, help="motion.json, as convert writes it")
    parser.add_argument("--title", metavar="TEXT", required=True, help="what people read")
    parser.add_argument(
        "--author", metavar="TEXT", default="Unknown", help="who made it (default: %(default)s)"
    )
    parser.add_argument(
        "--license",
        metavar="SPDX",
        default="LicenseRef-Proprietary",
        help="what others may do with it, as in CC0-1.0 (default: %(default)s)",
    )
    parser.add_argument(
        "--identifier", metavar="NAME", help="what it is known by; by default made of the title"
    )
    parser.add_argument(
        "--count", metavar="N", type=int, help="postures; by default 10 to 40, as many as differ"
    )
    _add_library_file(parser)


LEARN = Command(
    name="learn",
    summary="make a library of a finished motion",
    description=(
        "Makes a library of a motion's postures at spread-out, distinct frames, so that the next take of the "
        "same kind needs fewer keyframes or none. A motion that repeats itself becomes one average cycle."
    ),
    add_arguments=_add_learn,
    run=_use_case("learn_merge_mirror", "learn_command"),
)


def _add_blend(parser: argparse.ArgumentParser) -> None:
    _add_library(parser)
    _add_output(parser, "DIR", "folder of the assets")


BLEND = Command(
    name="blend",
    summary="write a library as Blender pose assets",
    description=(
        "Writes a folder to add to Blender's asset libraries: a .blend with a pose asset for each posture, "
        "and the catalog. Needs Blender."
    ),
    add_arguments=_add_blend,
    run=_use_case("blend_read", "blend_command"),
)


def _add_read(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="FILE.blend", type=Path, help="a .blend that Keymark wrote")
    parser.add_argument("--identifier", metavar="NAME", help="which library, where the .blend holds several")
    _add_library_file(parser)


READ = Command(
    name="read",
    summary="read a library from Blender pose assets",
    description="Writes as a library file what `blend` wrote, or what was posed since. Needs Blender.",
    add_arguments=_add_read,
    run=_use_case("blend_read", "read_command"),
)

LIBRARY = CommandGroup(
    name="library",
    description="Lists, looks at, checks, joins and makes keyframe libraries.",
    epilog="""\
examples:
  {program} list
  {program} show walking --sheet walking.png
  {program} learn out/walk/motion.json --title "Anna walking" --author Anna --output anna_walking.json
  {program} merge walking anna_walking.json --output studio.json

A library is a file, or the name of one that comes with Keymark or lies in a folder of KEYMARK_LIBRARIES.""",
    commands=(LIST, SHOW, CHECK, MERGE, MIRROR, LEARN, BLEND, READ),
)
