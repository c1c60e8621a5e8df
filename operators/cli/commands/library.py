"""Words of `keymark library`: what can be done with keyframe libraries, and the help."""

import argparse
from pathlib import Path

from ..line_parser import Commands, LineParser, UsageError, add_command, program_name

DESCRIPTION = "Lists, looks at, checks, joins and makes keyframe libraries."
EPILOG = """\
examples:
  {program} list
  {program} show walking --sheet walking.png
  {program} learn out/walk/motion.json --title "Anna walking" --author Anna --output anna_walking.json
  {program} merge walking anna_walking.json --output studio.json

A library is a file, or the name of one that comes with Keymark or lies in a folder of KEYMARK_LIBRARIES."""
NAME = "name or file of a library"


def add_library(commands: "Commands[LineParser]") -> None:
    """Add the command with its own commands."""
    program = f"{program_name()} library"
    library = commands.add_parser(
        "library",
        help="list, show, check, merge, mirror, learn and exchange keyframe libraries",
        description=DESCRIPTION,
        epilog=EPILOG.format(program=program),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    library.set_defaults(run=_no_command)
    inner = library.add_subparsers(metavar="COMMAND", title="commands")
    add_command(
        inner,
        "list",
        "list the libraries that can be named",
        "Lists the libraries that come with Keymark and those in the folders of KEYMARK_LIBRARIES.",
        _list,
    )
    show = add_command(
        inner, "show", "say what a library holds", "Says what a library holds, and draws it.", _show
    )
    show.add_argument("library", metavar="LIBRARY", help=NAME)
    show.add_argument("--sheet", metavar="FILE", type=Path, help="draw all its postures there, a PNG")
    check = add_command(
        inner,
        "check",
        "check library files",
        "Reads library files as strictly as Keymark always does and says what is wrong with each that is.",
        _check,
    )
    check.add_argument("files", metavar="FILE", type=Path, nargs="+", help="library files")
    _add_makers(inner)


def _add_makers(inner: "Commands[LineParser]") -> None:
    """Add the commands that write a library."""
    merge = add_command(
        inner,
        "merge",
        "join two libraries",
        "Writes the postures and motions of both libraries as one, on the proportions of the first. Two "
        "versions of one library are merged by name; different libraries become a new one, in which "
        "postures of the same name get a number.",
        _merge,
    )
    merge.add_argument("library", metavar="A", help=f"{NAME}, which gives title, author and proportions")
    merge.add_argument("other", metavar="B", help=NAME)
    merge.add_argument(
        "--conflicts",
        choices=("keep", "replace"),
        help="of two versions: what of A has changed in B is kept, or replaced; by default they are named "
        "and nothing is written",
    )
    merge.add_argument("--title", metavar="TEXT", help="of the new library; by default that of both")
    merge.add_argument(
        "--identifier", metavar="NAME", help="of the new library; by default made of the title"
    )
    mirror = add_command(
        inner,
        "mirror",
        "exchange left and right",
        "Writes a library with left and right exchanged in every posture and motion. Matching does so by "
        "itself; it is for posing.",
        _mirror,
    )
    mirror.add_argument("library", metavar="LIBRARY", help=NAME)
    mirror.add_argument(
        "--both", action="store_true", help="add the mirrored postures and motions that the library lacks"
    )
    learn = add_command(
        inner,
        "learn",
        "make a library of a finished motion",
        "Makes a library of a motion's postures at spread-out, distinct frames, so that the next take of the "
        "same kind needs fewer keyframes or none. A motion that repeats itself becomes one average cycle.",
        _learn,
    )
    learn.add_argument("motion", metavar="MOTION", type=Path, help="motion.json, as convert writes it")
    learn.add_argument("--title", metavar="TEXT", required=True, help="what people read")
    learn.add_argument(
        "--author", metavar="TEXT", default="Unknown", help="who made it (default: %(default)s)"
    )
    learn.add_argument(
        "--license",
        metavar="SPDX",
        default="LicenseRef-Proprietary",
        help="what others may do with it, as in CC0-1.0 (default: %(default)s)",
    )
    learn.add_argument(
        "--identifier", metavar="NAME", help="what it is known by; by default made of the title"
    )
    learn.add_argument(
        "--count", metavar="N", type=int, help="postures; by default 10 to 40, as many as differ"
    )
    blend = add_command(
        inner,
        "blend",
        "write a library as Blender pose assets",
        "Writes a folder to add to Blender's asset libraries: a .blend with a pose asset for each posture, "
        "and the catalog. Needs Blender.",
        _blend,
    )
    blend.add_argument("library", metavar="LIBRARY", help=NAME)
    read = add_command(
        inner,
        "read",
        "read a library from Blender pose assets",
        "Writes as a library file what `blend` wrote, or what was posed since. Needs Blender.",
        _read,
    )
    read.add_argument("file", metavar="FILE.blend", type=Path, help="a .blend that Keymark wrote")
    read.add_argument("--identifier", metavar="NAME", help="which library, where the .blend holds several")
    for maker in (merge, mirror, learn, read):
        maker.add_argument(
            "--output", "-o", metavar="FILE", type=Path, required=True, help="the new library file"
        )
    blend.add_argument("--output", "-o", metavar="DIR", type=Path, required=True, help="folder of the assets")
    for maker in (merge, mirror, learn, read, blend):
        maker.add_argument("--replace", action="store_true", help="replace what is there already")


def _no_command(_arguments: argparse.Namespace) -> None:
    raise UsageError(
        "no command is given; list, show, check, merge, mirror, learn, blend and read are valid, "
        f"see {program_name()} library --help"
    )


# Each imports what it needs when it runs: --help and mistakes shall not wait for scipy, OpenCV and Blender.


def _list(arguments: argparse.Namespace) -> None:
    from .inspect import list_command

    list_command(arguments)


def _show(arguments: argparse.Namespace) -> None:
    from .inspect import show_command

    show_command(arguments)


def _check(arguments: argparse.Namespace) -> None:
    from .inspect import check_command

    check_command(arguments)


def _merge(arguments: argparse.Namespace) -> None:
    from .make import merge_command

    merge_command(arguments)


def _mirror(arguments: argparse.Namespace) -> None:
    from .make import mirror_command

    mirror_command(arguments)


def _learn(arguments: argparse.Namespace) -> None:
    from .make import learn_command

    learn_command(arguments)


def _blend(arguments: argparse.Namespace) -> None:
    from .pose_assets import blend_command

    blend_command(arguments)


def _read(arguments: argparse.Namespace) -> None:
    from .pose_assets import read_command

    read_command(arguments)
