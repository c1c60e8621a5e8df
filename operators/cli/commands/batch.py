"""Words of the commands for shoots: new, check, batch and merge, and how a batch's workers are called."""

import argparse
from pathlib import Path

from ...core.take.methods import METHODS
from .line_parser import Commands, LineParser, add_command

SHOOT_HELP = "folder of takes, or a list of them (JSON Lines, .jsonl)"
WORKER = "worker"
"""The command that a batch's worker processes run; nobody else calls it."""


def add_shoot_commands(commands: "Commands[LineParser]") -> None:
    """Add the commands that work on many takes."""
    _add_new(commands)
    _add_check(commands)
    _add_batch(commands)
    _add_merge(commands)
    commands.add_parser(WORKER).set_defaults(run=_worker, quiet=True)


def _add_new(commands: "Commands[LineParser]") -> None:
    new = add_command(
        commands,
        "new",
        "describe a folder of clips: write its shoot.json",
        "Looks at the clips below a folder and writes shoot.json there, with what the clips tell filled in "
        "and comments on what a person must say: camera, actor and markers, once for all clips.",
        _new,
    )
    new.add_argument("shoot", metavar="SHOOT", type=Path, help="folder of clips")
    new.add_argument(
        "--output", "-o", metavar="FILE", type=Path, help="where to write; by default SHOOT/shoot.json"
    )


def _add_check(commands: "Commands[LineParser]") -> None:
    check = add_command(
        commands,
        "check",
        "look through a shoot before it is converted",
        "Reads everything a batch would read, samples frames of every clip, and says for each take whether "
        "it would convert, how well its markers are seen and what is likely to go wrong. Nothing is written.",
        _check,
    )
    check.add_argument("shoot", metavar="SHOOT", type=Path, help=f"{SHOOT_HELP}, or one take")
    check.add_argument("--jobs", "-j", metavar="N", type=int, help="look at N takes at a time")
    _add_defaults(check)


def _add_batch(commands: "Commands[LineParser]") -> None:
    batch = add_command(
        commands,
        "batch",
        "convert every take of a shoot",
        "Converts every take below a folder, or those of a list, each into DIR under its way from SHOOT. "
        "Takes that were converted before from the same input and settings are skipped, so that a batch that "
        "was interrupted goes on when it is called again. A take that fails stops no other. DIR/summary.html "
        "shows what came out. Exit status: 0 all takes are converted, 1 some failed, 2 the shoot is "
        "unusable, 130 interrupted.",
        _batch,
    )
    batch.add_argument("shoot", metavar="SHOOT", type=Path, help=SHOOT_HELP)
    batch.add_argument(
        "--output", "-o", metavar="DIR", type=Path, required=True, help="folder for all results, new or old"
    )
    batch.add_argument(
        "--jobs",
        "-j",
        metavar="N",
        type=int,
        help="convert N takes at a time, each in a process of its own; by default one for each processor, at "
        "most one for each 1.5 GB of memory",
    )
    batch.add_argument(
        "--part",
        metavar="K/N",
        help="convert the K-th of N shares of the takes only, as one of N machines",
    )
    batch.add_argument(
        "--take",
        metavar="NAME",
        action="append",
        help="convert this take only, named by its way from SHOOT; may be given several times",
    )
    batch.add_argument("--again", action="store_true", help="convert takes anew that are converted already")
    _add_defaults(batch)
    batch.add_argument("--no-report", action="store_true", help="draw no pictures of takes")
    batch.add_argument(
        "--failed-takes",
        choices=("fail", "pass"),
        default="fail",
        help="what the exit status says where takes have failed: 1 with fail, 0 with pass, so that a farm "
        "goes on to the tasks that wait for this one; merge then names them (default: %(default)s)",
    )


def _add_defaults(command: LineParser) -> None:
    """Add what counts where a shoot says nothing."""
    command.add_argument(
        "--library",
        metavar="NAME|FILE|auto",
        type=_unless_empty,
        help="match takes with this keyframe library where nothing in SHOOT names one",
    )
    command.add_argument(
        "--floor",
        metavar="HEIGHT",
        type=float,
        help="height of the floor in meters where nothing in SHOOT says it",
    )
    command.add_argument(
        "--method", choices=METHODS, help="method where nothing in SHOOT names one; map is the default"
    )


def _add_merge(commands: "Commands[LineParser]") -> None:
    merge = add_command(
        commands,
        "merge",
        "gather the motions of a batch in one asset library",
        "Gathers the motions found below DIR in one .blend to add to Blender's asset libraries, with "
        "catalogs by shoot and folder: each as an Action, which any actor of Keymark's can be given, and as "
        "an actor to drag into a scene. Exit status: 0 all takes are in it, 1 some have failed or are "
        "damaged and the others are in it, 2 there are none.",
        _merge,
    )
    merge.add_argument("results", metavar="DIR", type=Path, help="folder of results, as batch writes it")
    merge.add_argument(
        "--output", "-o", metavar="FILE", type=Path, required=True, help="the .blend to write, new or old"
    )
    merge.add_argument("--name", metavar="NAME", help="what the shoot is called; by default DIR's name")


def _unless_empty(text: str) -> str | None:
    """A text; none where it is empty, as farms give what nobody has filled in."""
    return text or None


# Commands are imported when they run: --help and mistakes shall not wait for scipy, OpenCV and Blender.


def _new(arguments: argparse.Namespace) -> None:
    from .new import new_command

    new_command(arguments)


def _check(arguments: argparse.Namespace) -> None:
    from .check import check_command

    check_command(arguments)


def _batch(arguments: argparse.Namespace) -> None:
    from .batch.command import batch_command

    batch_command(arguments)


def _merge(arguments: argparse.Namespace) -> None:
    from .merge import merge_command

    merge_command(arguments)


def _worker(_arguments: argparse.Namespace) -> None:
    from .batch.worker import worker_command

    worker_command()
