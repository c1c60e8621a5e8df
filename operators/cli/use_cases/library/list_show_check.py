"""`keymark library list`, `show` and `check`: looking at libraries."""

import argparse
from collections import Counter
from typing import Any

from ....core.errors import InputError
from ....core.files.json_file import write_whole
from ....core.library.library import Library, LibraryMotion
from ....core.library.library_file import read_library
from ....core.library.registry import find_library, shelved
from ....core.report.canvas import write_png
from ..console import arguments_console
from ..line_parser import UsageError
from .folders import library_folders


def list_command(arguments: argparse.Namespace) -> None:
    """List what lies on the shelf, also what cannot be used and why."""
    with arguments_console(arguments) as console:
        found = shelved(library_folders())
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
    """Say what a library holds; draw it where that is wanted.

    Raises:
        UsageError: The picture is no .png: a library named there by mistake must not become one.
    """
    if arguments.sheet is not None and arguments.sheet.suffix.lower() != ".png":
        raise UsageError(f"--sheet is {str(arguments.sheet)!r}; name a file that ends in .png")
    with arguments_console(arguments) as console:
        library = find_library(arguments.library, library_folders())
        lines = described(library)
        result = library_summary(library)
        if arguments.sheet is not None:
            from ....core.report.library_sheet import library_sheet

            console.stage("Drawing the postures")
            picture = library_sheet(library)
            write_whole(arguments.sheet, lambda beside: write_png(str(beside), picture))
            lines.append(f"Picture: {arguments.sheet}")
            result["sheet"] = str(arguments.sheet)
        console.finish(result, "\n".join(lines))


def check_command(arguments: argparse.Namespace) -> None:
    """Read files and say what is wrong with them.

    Raises:
        InputError: Something is: all that is, in one line.
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


def library_summary(library: Library) -> dict[str, Any]:
    """What a library is, for `--json`."""
    return {
        "identifier": library.identifier,
        "title": library.title,
        "version": library.version,
        "author": library.author,
        "license": library.license,
        "description": library.description,
        "tags": list(library.tags),
        "sources": list(library.sources),
        "stature_m": round(library.actor.stature_m, 3),
        "postures": [posture.name for posture in library.postures],
        "motions": [
            {
                "name": motion.name,
                "cyclic": motion.cyclic,
                "duration_s": motion.duration_s,
                "steps": len(motion.steps),
                "travel": list(motion.travel),
            }
            for motion in library.motions
        ],
    }


def described(library: Library) -> list[str]:
    """What a library is, line by line."""
    lines = [
        f"{library.title} ({library.identifier}, version {library.version})",
        *([library.description] if library.description else []),
        f"By {library.author}; license {library.license}; posed on {100.0 * library.actor.stature_m:.0f} cm",
        f"{library.size}:",
        *(f"  {_motion(motion)}" for motion in library.motions),
    ]
    steps = Counter(step.posture for motion in library.motions for step in motion.steps)
    loose = [posture.name for posture in library.postures if not steps[posture.name]]
    if loose:
        lines.append(f"  in no motion: {', '.join(loose)}")
    return [*lines, *(f"Source: {source}" for source in library.sources)]


def _motion(motion: LibraryMotion) -> str:
    kind = "again and again, " if motion.cyclic else ""
    x, y, _ = motion.travel
    way = (x * x + y * y) ** 0.5
    travel = f", {way:.2f} m on" if way >= 0.01 else ""
    return f"{motion.name}: {len(motion.steps)} postures, {kind}{motion.duration_s:.2f} s{travel}"
