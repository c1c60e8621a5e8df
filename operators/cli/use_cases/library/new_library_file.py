"""The library file that `learn`, `merge`, `mirror` and `read` write, and what they say of it."""

import argparse

from .....core.library.library import Library
from .....core.library.library_file import write_library
from ...console import Console
from .library_summary import library_lines, library_summary


def write_new_library(console: Console, arguments: argparse.Namespace, library: Library) -> None:
    """Write a library to `--output` and finish the command with its summary."""
    write_library(arguments.output, library)
    result = {**library_summary(library), "files": [str(arguments.output)]}
    console.finish(result, "\n".join([*library_lines(library), f"Written: {arguments.output}"]))
