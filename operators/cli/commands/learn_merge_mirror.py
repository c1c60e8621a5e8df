"""`keymark library learn`, `merge` and `mirror`: a new library from a motion or from libraries."""

import argparse

from ....core.errors import InputError
from ....core.files.fields import listed
from ....core.prior.learning import LibraryMetadata, learn_library
from ....core.prior.library import Library
from ....core.prior.merging import differing_names, join_libraries, merge_versions
from ....core.prior.registry import find_library
from ....core.prior.texts import LONGEST_NAME, checked_identifier, identifier_from
from ....core.prior.transfer import mirrored_library, with_mirrored
from ....core.take.motion import read_motion
from ..console import arguments_console
from ..library_search_path import library_folders
from ..parser import UsageError, refuse_existing
from .library import write_new_library


def learn_command(arguments: argparse.Namespace) -> None:
    """Make a library of a finished motion."""
    refuse_existing(arguments.output, arguments.replace)
    if arguments.identifier is not None:
        checked_identifier(arguments.identifier, "--identifier")
    with arguments_console(arguments) as console:
        console.stage("Reading the motion")
        motion = read_motion(arguments.motion)
        about = LibraryMetadata(
            title=arguments.title,
            author=arguments.author,
            license=arguments.license,
            identifier=arguments.identifier or "",
        )
        console.stage("Choosing postures")
        library = learn_library(motion.body, motion.posture, motion.time_s, about, arguments.count)
        write_new_library(console, arguments, library)


def merge_command(arguments: argparse.Namespace) -> None:
    """Make one library of two."""
    refuse_existing(arguments.output, arguments.replace)
    with arguments_console(arguments) as console:
        folders = library_folders()
        first, second = (find_library(name, folders) for name in (arguments.library, arguments.other))
        if first.identifier == second.identifier:
            library = _merge_versions(first, second, arguments.conflicts)
        else:
            title = arguments.title or f"{first.title} and {second.title}"[:LONGEST_NAME].strip()
            identifier = arguments.identifier or identifier_from(title, [first.identifier, second.identifier])
            library = join_libraries(first, second, identifier, title)
        write_new_library(console, arguments, library)


def _merge_versions(first: Library, second: Library, conflicts: str | None) -> Library:
    """Merge two versions of one library.

    Raises:
        UsageError: They differ, and `--conflicts` does not say which counts.
    """
    changed = differing_names(first, second)
    if changed and conflicts is None:
        names = listed(map(repr, changed), 5)
        raise UsageError(f"both versions of {first.identifier} have {names}, and differ; add --conflicts")
    return merge_versions(first, second, None if conflicts is None else conflicts == "replace")


def mirror_command(arguments: argparse.Namespace) -> None:
    """Exchange left and right.

    Raises:
        InputError: `--both` is given for an actor whose left and right sides differ.
    """
    refuse_existing(arguments.output, arguments.replace)
    with arguments_console(arguments) as console:
        library = find_library(arguments.library, library_folders())
        if not arguments.both:
            write_new_library(console, arguments, mirrored_library(library))
            return
        try:
            both = with_mirrored(library)
        except ValueError as error:
            raise InputError(f"library {library.identifier!r}: {error}") from error
        write_new_library(console, arguments, both)
