"""Library registry: the libraries in some folders, found by identifier, title or path."""

import os
from collections.abc import Sequence
from pathlib import Path

from ..errors import InputError
from ..files.json_file import ENDING, is_path
from ..files.records import Registered, find_registered, registered_files
from .library import LARGEST_BYTES, Library, read_library
from .texts import EVERY_LIBRARY, checked_identifier, name_key

SHIPPED = Path(__file__).resolve().parents[2] / "presets" / "keyframes"  # they come with Keymark


def registered_libraries(folders: Sequence[Path]) -> tuple[Registered[Library], ...]:
    """All library files in some folders, in order of title, by identifier; of versions the highest."""
    return registered_files(
        folders, Library, LARGEST_BYTES, lambda one: one.identifier, lambda one: one.version
    )


def identifier_of(entry: Registered[Library]) -> str:
    """A library's identifier; the stem of an invalid file's name."""
    return entry.path.stem if entry.content is None else entry.content.identifier


def find_library(name_or_path: str | Path, folders: Sequence[Path]) -> Library:
    """Find a library by its identifier, title or path.

    A name that ends in `.json` or contains a path separator is a path.

    Raises:
        InputError: There is no such library, or it is invalid.
    """
    if is_path(name_or_path):
        return read_library(Path(name_or_path))
    entries = registered_libraries(folders)
    return find_registered(
        os.fspath(name_or_path),
        entries,
        lambda entry: (identifier_of(entry), entry.title),
        name_key,
        "keyframe library",
    ).valid


def find_libraries(name_or_path: str | Path, folders: Sequence[Path]) -> tuple[Library, ...]:
    """Find the library of an identifier, title or path; every valid one, by title, for `EVERY_LIBRARY`.

    Raises:
        InputError: There is no such library, or none at all, or it is invalid.
    """
    if name_or_path != EVERY_LIBRARY:
        return (find_library(name_or_path, folders),)
    found = tuple(entry.content for entry in registered_libraries(folders) if entry.content is not None)
    if not found:
        raise InputError("there is no keyframe library; import one, or install Keymark as a whole")
    return found


def library_path(folder: Path, identifier: str) -> Path:
    """Path of a library's file in a folder, never outside of it.

    Raises:
        InputError: The identifier is invalid.
    """
    return folder / (checked_identifier(identifier, "the library's identifier") + ENDING)
