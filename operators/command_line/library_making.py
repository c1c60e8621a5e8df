"""`keymark library learn`, `merge` and `mirror`: new libraries from what there is."""

import argparse

from ...core.library.learning import About, learn_library
from ...core.library.library import Library
from ...core.library.library_file import write_library
from ...core.library.texts import checked_identifier
from ...core.motion_file import read_motion
from .console import Console, arguments_console
from .libraries import refuse_existing
from .library import described, library_summary


def learn_command(arguments: argparse.Namespace) -> None:
    """Make a library of a finished motion."""
    refuse_existing(arguments.output, arguments.replace)
    if arguments.identifier is not None:
        checked_identifier(arguments.identifier, "--identifier")
    with arguments_console(arguments) as console:
        console.stage("Reading the motion")
        motion = read_motion(arguments.motion)
        about = About(
            title=arguments.title,
            author=arguments.author,
            license=arguments.license,
            identifier=arguments.identifier or "",
        )
        console.stage("Choosing postures")
        library = learn_library(motion.body, motion.posture, motion.time_s, about, arguments.count)
        _keep(console, arguments, library)


def _keep(console: Console, arguments: argparse.Namespace, library: Library) -> None:
    """Write a library, and say so."""
    write_library(arguments.output, library)
    result = {**library_summary(library), "files": [str(arguments.output)]}
    console.finish(result, "\n".join([*described(library), f"Written: {arguments.output}"]))
