"""Library registry: the libraries in some folders, found by identifier, title or path."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from ..errors import InputError, shown
from ..files.fields import listed
from ..files.json_file import ENDING, is_other_format, is_path, json_files, read_json
from .library import LARGEST_BYTES, Library, read_library
from .texts import EVERY_LIBRARY, checked_identifier

SHIPPED = Path(__file__).resolve().parents[2] / "presets" / "keyframes"  # they come with Keymark


@dataclass(frozen=True)
class RegisteredLibrary:
    """A library file in a registered folder."""

    path: Path
    library: Library | None  # the library; None if the file is invalid
    problem: str = ""  # the sentence of the error that makes it invalid

    @property
    def identifier(self) -> str:
        """The library's identifier; the stem of an invalid file's name."""
        return self.library.identifier if self.library else self.path.stem

    @property
    def title(self) -> str:
        """The library's title; an invalid file's name."""
        return self.library.title if self.library else self.path.name

    @property
    def version(self) -> int:
        """The library's version; 0 for an invalid file."""
        return self.library.version if self.library else 0


def registered_libraries(folders: Sequence[Path]) -> tuple[RegisteredLibrary, ...]:
    """All library files in some folders, in order of title; missing folders count as empty.

    Of several libraries with one identifier only the one in the earliest folder is registered, and within a
    folder the one of the highest version; the others are available by path only.
    """
    found: dict[str, RegisteredLibrary] = {}
    broken: list[RegisteredLibrary] = []
    for folder in folders:
        here: dict[str, RegisteredLibrary] = {}
        for entry in filter(None, map(_read, json_files(folder))):
            if entry.library is None:
                broken.append(entry)
            elif entry.identifier not in here or entry.version > here[entry.identifier].version:
                here[entry.identifier] = entry
        found = here | found
    return tuple(sorted([*found.values(), *broken], key=lambda entry: (entry.title.casefold(), entry.path)))


def find_library(name_or_path: str | Path, folders: Sequence[Path]) -> Library:
    """Find a library by its identifier, title or path.

    A name that ends in `.json` or contains a path separator is a path.

    Raises:
        InputError: There is no such library, or it is invalid.
    """
    if is_path(name_or_path):
        return read_library(Path(name_or_path))
    text = os.fspath(name_or_path)
    registered = registered_libraries(folders)
    wanted = text.casefold()
    by_identifier = [entry for entry in registered if entry.identifier.casefold() == wanted]
    by_title = [entry for entry in registered if entry.title.casefold() == wanted]
    # Valid libraries come first: a damaged file may have any name, and a stranger's library any title.
    for entry in sorted([*by_identifier, *by_title], key=lambda entry: entry.library is None):
        if entry.library is None:
            raise InputError(entry.problem)
        return entry.library
    names = [entry.identifier for entry in registered if entry.library]
    close = get_close_matches(text[:100], names, n=1, cutoff=0.6)
    hint = f" (is {shown(close[0])} meant?)" if close else ""
    raise InputError(
        f"there is no keyframe library {shown(text)}{hint}; known are {listed(names) or 'none'}, "
        "and the path of a file ends in .json"
    )


def find_libraries(name_or_path: str | Path, folders: Sequence[Path]) -> tuple[Library, ...]:
    """Find the library of an identifier, title or path; every valid one, by title, for `EVERY_LIBRARY`.

    Raises:
        InputError: There is no such library, or none at all, or it is invalid.
    """
    if name_or_path != EVERY_LIBRARY:
        return (find_library(name_or_path, folders),)
    found = tuple(entry.library for entry in registered_libraries(folders) if entry.library is not None)
    if not found:
        raise InputError("there is no keyframe library; import one, or install Keymark as a whole")
    return found


def library_path(folder: Path, identifier: str) -> Path:
    """Path of a library's file in a folder, never outside of it.

    Raises:
        InputError: The identifier is invalid.
    """
    return folder / (checked_identifier(identifier, "the library's identifier") + ENDING)


def _read(path: Path) -> RegisteredLibrary | None:
    """The library of a file; None for a file of another of Keymark's formats."""
    try:
        value = read_json(path, LARGEST_BYTES)
        if is_other_format(value, Library.SCHEMA):
            return None
        return RegisteredLibrary(path, Library.from_json(value, str(path)))
    except InputError as error:
        return RegisteredLibrary(path, None, str(error))
