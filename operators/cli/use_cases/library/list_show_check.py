"""`keymark library list`, `show` and `check`."""

import argparse

from .....core.errors import InputError
from .....core.files.json_file import write_atomically
from .....core.library.library_file import read_library
from .....core.library.registry import find_library, registered_libraries
from .....core.report.canvas import write_png
from ...console import arguments_console
from ...library_search_path import library_folders
from ...usage import UsageError
from .library_summary import library_lines, library_summary


def list_command(arguments: argparse.Namespace) -> None:
    """List the libraries of the search path, those that cannot be used with the reason."""
    with arguments_console(arguments) as console:
        found = registered_libraries(library_folders())
        rows = [
            {
                "identifier": entry.identifier,
                "title": entry.title,
                "version": entry.version,
                "postures": len(entry.library.postures) if entry.library else 0,
                "file": str(entry.path),
                "problem": entry.problem,
            }
            for entry in found
        ]
        width = max((len(entry.identifier) for entry in found), default=0)
        lines = [
            f"{entry.identifier:{width}}  {entry.title}, {entry.library.size}"
            if entry.library
            else f"{entry.identifier:{width}}  cannot be used: {entry.problem}"
            for entry in found
        ]
        console.finish({"libraries": rows}, "\n".join(lines) or "There are no libraries.")


def show_command(arguments: argparse.Namespace) -> None:
    """Print a library's contents; draw its postures where `--sheet` is given.

    Raises:
        UsageError: The picture is no .png: a library named there by mistake must not be overwritten.
    """
    if arguments.sheet is not None and arguments.sheet.suffix.lower() != ".png":
        raise UsageError(f"--sheet is {str(arguments.sheet)!r}; name a file that ends in .png")
    with arguments_console(arguments) as console:
        library = find_library(arguments.library, library_folders())
        lines = library_lines(library)
        result = library_summary(library)
        if arguments.sheet is not None:
            from .....core.report.library_sheet import library_sheet

            console.stage("Drawing the postures")
            picture = library_sheet(library)
            write_atomically(arguments.sheet, lambda staged: write_png(str(staged), picture))
            lines.append(f"Picture: {arguments.sheet}")
            result["sheet"] = str(arguments.sheet)
        console.finish(result, "\n".join(lines))


def check_command(arguments: argparse.Namespace) -> None:
    """Read library files and print what they hold.

    Raises:
        InputError: Files are invalid; one line names the problem of each.
    """
    with arguments_console(arguments) as console:
        problems, lines, good = [], [], []
        for file in arguments.files:
            try:
                library = read_library(file)
            except InputError as error:
                problems.append(str(error))
                continue
            good.append({"file": str(file), **library_summary(library)})
            lines.append(f"{file}: {library.title}, version {library.version}, {library.size}")
        if problems:
            raise InputError("; ".join(problems))
        console.finish({"libraries": good}, "\n".join(lines))
