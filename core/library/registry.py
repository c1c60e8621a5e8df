"""Where libraries are found by name: folders of library files, those shipped with Keymark among them."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from ..errors import InputError
from ..files.fields import listed
from ..files.json_file import shown
from .library import Library
from .library_file import read_library
from .texts import checked_identifier

SHIPPED = Path(__file__).resolve().parents[2] / "presets" / "keyframes"
"""The libraries that come with Keymark."""
ENDING = ".json"
MOST_FILES = 500
"""Of one folder; what lies beyond is not looked at."""


@dataclass(frozen=True)
class RegisteredLibrary:
    """A file on the shelf."""

    path: Path
    library: Library | None
    """What is in it; None where it cannot be used."""
    problem: str = ""
    """A sentence that says why it cannot be used."""

    @property
    def identifier(self) -> str:
        """The library's identifier, or what of the file's name stands for it."""
        return self.library.identifier if self.library else self.path.stem

    @property
    def title(self) -> str:
        """The library's title; the file's name where there is none."""
        return self.library.title if self.library else self.path.name

    @property
    def version(self) -> int:
        """The library's version, 0 where there is none."""
        return self.library.version if self.library else 0


def registered_libraries(folders: Sequence[Path]) -> tuple[RegisteredLibrary, ...]:
    """Everything in some folders, in order of title; folders that are not there are empty.

    Of several libraries with one identifier only that of the earliest folder is on the shelf, and within a
    folder the one of the highest version; the rest can be reached by their files.
    """
    found: dict[str, RegisteredLibrary] = {}
    broken: list[RegisteredLibrary] = []
    for folder in folders:
        here: dict[str, RegisteredLibrary] = {}
        for path in _files(folder):
            entry = _read(path)
            if entry.library is None:
                broken.append(entry)
            elif entry.identifier not in here or entry.version > here[entry.identifier].version:
                here[entry.identifier] = entry
        found = here | found
    return tuple(sorted([*found.values(), *broken], key=lambda entry: (entry.title.casefold(), entry.path)))


def find_library(name_or_path: str | Path, folders: Sequence[Path]) -> Library:
    """A library by its identifier or title, or by its file.

    What ends in `.json`, or holds a `/` (or whatever parts folders on this system), is a file.

    Raises:
        InputError: There is no such library, or it cannot be used.
    """
    text = os.fspath(name_or_path)
    parted = any(mark in text for mark in (os.sep, os.altsep, "/") if mark)
    if isinstance(name_or_path, Path) or parted or text.lower().endswith(ENDING):
        return read_library(Path(name_or_path))
    shelf = registered_libraries(folders)
    wanted = text.casefold()
    called = [entry for entry in shelf if entry.identifier.casefold() == wanted]
    titled = [entry for entry in shelf if entry.title.casefold() == wanted]
    # What can be used counts first: a damaged file may have any name, and a stranger's library any title.
    for entry in sorted([*called, *titled], key=lambda entry: entry.library is None):
        if entry.library is None:
            raise InputError(entry.problem)
        return entry.library
    names = [entry.identifier for entry in shelf if entry.library]
    close = get_close_matches(text[:100], names, n=1, cutoff=0.6)
    hint = f" (is {shown(close[0])} meant?)" if close else ""
    raise InputError(
        f"there is no keyframe library {shown(text)}{hint}; known are {listed(names) or 'none'}, "
        "and a file ends in .json"
    )


def library_path(folder: Path, identifier: str) -> Path:
    """The file of a library in a folder: never outside of it.

    Raises:
        InputError: The identifier is none.
    """
    return folder / (checked_identifier(identifier, "the library's identifier") + ENDING)


def _files(folder: Path) -> list[Path]:
    try:
        files = [path for path in folder.iterdir() if path.suffix.lower() == ENDING and path.is_file()]
    except OSError:
        return []
    return sorted(files)[:MOST_FILES]


def _read(path: Path) -> RegisteredLibrary:
    try:
        return RegisteredLibrary(path, read_library(path))
    except InputError as error:
        return RegisteredLibrary(path, None, str(error))
