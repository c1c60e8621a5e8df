"""`keymark batch`: its arguments."""

import argparse
from pathlib import Path

from ..command import Command
from .shoot_options import SHOOT_HELP, add_defaults


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the shoot, which of its takes are converted, where to and how."""
    parser.add_argument("shoot", metavar="SHOOT", type=Path, help=SHOOT_HELP)
    parser.add_argument(
        "--output", "-o", metavar="DIR", type=Path, required=True, help="folder for all results, new or old"
    )
    parser.add_argument(
        "--jobs",
        "-j",
        metavar="N",
        type=int,
        help="convert N takes at a time, each in a process of its own; by default one for each processor, at "
        "most one for each 1.5 GB of memory",
    )
    parser.add_argument(
        "--part",
        metavar="K/N",
        help="convert the K-th of N shares of the takes only, as one of N machines",
    )
    parser.add_argument(
        "--take",
        metavar="NAME",
        action="append",
        help="convert this take only, named by its way from SHOOT; may be given several times",
    )
    parser.add_argument("--again", action="store_true", help="convert takes anew that are converted already")
    add_defaults(parser)
    parser.add_argument("--no-report", action="store_true", help="draw no pictures of takes")
    parser.add_argument(
        "--failed-takes",
        choices=("fail", "pass"),
        default="fail",
        help="what the exit status says where takes have failed: 1 with fail, 0 with pass, so that a farm "
        "goes on to the tasks that wait for this one; merge then names them (default: %(default)s)",
    )


def run(arguments: argparse.Namespace) -> None:
    """Convert the takes."""
    from ..use_cases.batch import batch_command

    batch_command(arguments)


BATCH = Command(
    name="batch",
    summary="convert every take of a shoot",
    description=(
        "Converts every take below a folder, or those of a list, each into DIR under its way from SHOOT. "
        "Takes that were converted before from the same input and settings are skipped, so that a batch that "
        "was interrupted goes on when it is called again. A take that fails stops no other. DIR/summary.html "
        "shows what came out. Exit status: 0 all takes are converted, 1 some failed, 2 the shoot is "
        "unusable, 130 interrupted."
    ),
    add_arguments=add_arguments,
    run=run,
)
