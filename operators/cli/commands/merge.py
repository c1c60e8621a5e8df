"""`keymark merge`: its arguments."""

import argparse
from pathlib import Path

from ..command import Command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the results, the .blend to write and the shoot's name in it."""
    parser.add_argument("results", metavar="DIR", type=Path, help="folder of results, as batch writes it")
    parser.add_argument(
        "--output", "-o", metavar="FILE", type=Path, required=True, help="the .blend to write, new or old"
    )
    parser.add_argument("--name", metavar="NAME", help="what the shoot is called; by default DIR's name")


def run(arguments: argparse.Namespace) -> None:
    """Gather the motions."""
    from ..use_cases.merge import merge_command

    merge_command(arguments)


MERGE = Command(
    name="merge",
    summary="gather the motions of a batch in one asset library",
    description=(
        "Gathers the motions found below DIR in one .blend to add to Blender's asset libraries, with "
        "catalogs by shoot and folder: each as an Action, which any actor of Keymark's can be given, and as "
        "an actor to drag into a scene. Exit status: 0 all takes are in it, 1 some have failed or are "
        "damaged and the others are in it, 2 there are none."
    ),
    add_arguments=add_arguments,
    run=run,
)
