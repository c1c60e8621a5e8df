"""`keymark library`: list, show, check, learn and exchange keyframe libraries."""

import argparse
from collections import Counter
from math import hypot
from pathlib import Path
from typing import Any

from ....core.errors import InputError
from ....core.prior.library import Library, read_library, write_library
from ....core.prior.registry import find_library, identifier_of, registered_libraries
from ....core.prior.texts import checked_identifier
from ..blender_silence import blender_silence
from ..console import CommandGroup, Console, argument, command, refuse_existing, require_blender
from ..conversion.blender_files import library_folders
from ..options import REPLACE_HELP, output

LIBRARY_NAME = argument("library LIBRARY", "name or file of a library")
LIBRARY_FILE = output("FILE", "the new library file", replace=REPLACE_HELP)


def library_summary(library: Library) -> dict[str, Any]:
    """A library's contents as an object for `--json`."""
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


def library_lines(library: Library) -> list[str]:
    """A library's contents as lines for people."""
    lines = [
        f"{library.title} ({library.identifier}, version {library.version})",
        *([library.description] if library.description else []),
        f"By {library.author}; license {library.license}; posed on {100.0 * library.actor.stature_m:.0f} cm",
        f"{library.size}:",
    ]
    for motion in library.motions:
        kind, distance_m = "again and again, " * motion.cyclic, hypot(*motion.travel[:2])
        travel = f", {distance_m:.2f} m on" if distance_m >= 0.01 else ""
        lines.append(
            f"  {motion.name}: {len(motion.steps)} postures, {kind}{motion.duration_s:.2f} s{travel}"
        )
    steps = Counter(step.posture for motion in library.motions for step in motion.steps)
    loose = [posture.name for posture in library.postures if not steps[posture.name]]
    if loose:
        lines.append(f"  in no motion: {', '.join(loose)}")
    return [*lines, *(f"Source: {source}" for source in library.sources)]


def write_new_library(console: Console, arguments: argparse.Namespace, library: Library) -> None:
    """Write a library to `--output` and finish the command with its summary."""
    write_library(arguments.output, library)
    result = {**library_summary(library), "files": [str(arguments.output)]}
    console.finish(result, "\n".join([*library_lines(library), f"Written: {arguments.output}"]))


@command(summary="list the libraries that can be named")
def list_command(arguments: argparse.Namespace, console: Console) -> None:
    """Lists the libraries that come with Keymark and those in the folders of KEYMARK_LIBRARIES."""
    found = registered_libraries(library_folders())
    rows = [
        {
            "identifier": identifier_of(entry),
            "title": entry.title,
            "version": entry.content.version if entry.content else 0,
            "postures": len(entry.content.postures) if entry.content else 0,
            "file": str(entry.path),
            "problem": entry.problem,
        }
        for entry in found
    ]
    width = max((len(identifier_of(entry)) for entry in found), default=0)
    lines = [
        f"{identifier_of(entry):{width}}  {entry.title}, {entry.content.size}"
        if entry.content
        else f"{identifier_of(entry):{width}}  cannot be used: {entry.problem}"
        for entry in found
    ]
    console.finish({"libraries": rows}, "\n".join(lines) or "There are no libraries.")


@command(LIBRARY_NAME, summary="say what a library holds")
def show_command(arguments: argparse.Namespace, console: Console) -> None:
    """Says what a library holds, and draws it."""
    library = find_library(arguments.library, library_folders())
    console.finish(library_summary(library), "\n".join(library_lines(library)))


@command(argument("files FILE", "library files", type=Path, nargs="+"), summary="check library files")
def check_command(arguments: argparse.Namespace, console: Console) -> None:
    """Reads library files as strictly as Keymark always does and says what is wrong with each that is."""
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


@command(
    LIBRARY_NAME,
    *output("DIR", "folder of the assets", replace=REPLACE_HELP),
    summary="write a library as Blender pose assets",
)
def blend_command(arguments: argparse.Namespace, console: Console) -> None:
    """Writes a folder to add to Blender's asset libraries: a pose asset for each posture, the catalog.

    Needs Blender.
    """
    require_blender("pose assets need")
    library = find_library(arguments.library, library_folders())
    file = arguments.output / f"{checked_identifier(library.identifier, 'the identifier')}.blend"
    refuse_existing(file, arguments.replace)
    console.stage("Writing Blender's files")
    with blender_silence(arguments.debug):
        from ...bridge.asset_catalogs import NAME
        from ...bridge.library import write_library_blend

        write_library_blend(file, library)
    files = [str(file), str(arguments.output / NAME)]
    text = f"{library.title}: {len(library.postures)} pose assets\n" + "\n".join(f"  {f}" for f in files)
    console.finish({**library_summary(library), "files": files}, text)


@command(
    argument("file FILE.blend", "a .blend that Keymark wrote", type=Path),
    argument("--identifier NAME", "which library, where the .blend holds several"),
    *LIBRARY_FILE,
    summary="read a library from Blender pose assets",
)
def read_command(arguments: argparse.Namespace, console: Console) -> None:
    """Writes as a library file what `blend` wrote, or what was posed since.

    Needs Blender.
    """
    require_blender("pose assets need")
    refuse_existing(arguments.output, arguments.replace)
    console.stage("Reading the pose assets")
    with blender_silence(arguments.debug):
        from ...bridge.library import read_library_blend

        found = read_library_blend(arguments.file)
    chosen = [one for one in found if arguments.identifier in (None, one.identifier)]
    if len(chosen) != 1:
        names = ", ".join(one.identifier for one in found)
        raise InputError(f"{arguments.file}: holds the libraries {names}; name one with --identifier")
    write_new_library(console, arguments, chosen[0])


@command(
    argument("motion MOTION", "motion.json, as convert writes it", type=Path),
    argument("--title TEXT", "what people read", required=True),
    argument("--author TEXT", "who made it (default: %(default)s)", default="Unknown"),
    argument(
        "--license SPDX",
        "what others may do with it, as in CC0-1.0 (default: %(default)s)",
        default="LicenseRef-Proprietary",
    ),
    argument("--identifier NAME", "what it is known by; by default made of the title"),
    argument("--count N", "postures; by default 10 to 40, as many as differ", type=int),
    *LIBRARY_FILE,
    summary="make a library of a finished motion",
)
def learn_command(arguments: argparse.Namespace, console: Console) -> None:
    """Makes a library of a motion's postures at spread-out, distinct frames.

    With it the next take of the same kind needs fewer keyframes or none.
    """
    from ....core.prior.learning import LibraryMetadata, learn_library
    from ....core.take.motion import read_motion

    refuse_existing(arguments.output, arguments.replace)
    if arguments.identifier is not None:
        checked_identifier(arguments.identifier, "--identifier")
    console.stage("Reading the motion")
    motion = read_motion(arguments.motion).without_absence()
    values = {name: getattr(arguments, name) or "" for name in ("title", "author", "license", "identifier")}
    about = LibraryMetadata(**values)
    console.stage("Choosing postures")
    library = learn_library(motion.body, motion.posture, motion.time_s, about, arguments.count)
    write_new_library(console, arguments, library)


library_command = CommandGroup(
    description="Lists, looks at, checks and makes keyframe libraries.",
    epilog="""\
examples:
  {program} list
  {program} show walking
  {program} learn out/walk/motion.json --title "Anna walking" --author Anna --output anna_walking.json

A library is a file, or the name of one that comes with Keymark or lies in a folder of KEYMARK_LIBRARIES.""",
    commands={
        "list": list_command,
        "show": show_command,
        "check": check_command,
        "learn": learn_command,
        "blend": blend_command,
        "read": read_command,
    },
)
