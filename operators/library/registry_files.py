"""Files of the registry: the user's folder and the libraries that come with Keymark, read and written."""

from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path

from ...core.errors import InputError
from ...core.prior.library import Library, write_library
from ...core.prior.registry import (
    find_libraries,
    find_library,
    identifier_of,
    library_path,
    registered_libraries,
)
from ...core.prior.texts import EVERY_LIBRARY
from . import registry


def load_registered(identifier: str) -> Library:
    """The registered library of an identifier; an InputError without a usable file of it."""
    return find_library(identifier, registry.folders())


def find_registered(identifier: str) -> Library | None:
    """The registered library of exactly this identifier; None where there is no usable one."""
    found = (
        entry.content
        for entry in registered_libraries(registry.folders())
        if identifier_of(entry) == identifier
    )
    return next((library for library in found if library is not None), None)


def named_libraries(name: str) -> Sequence[Library]:
    """All libraries where `EVERY_LIBRARY` or nothing is said, else the one of this identifier, title or file.

    Raises:
        InputError: There is no such library.
    """
    return all_libraries() if name in ("", EVERY_LIBRARY) else [load_registered(name)]


def all_libraries() -> Sequence[Library]:
    """All registered libraries; the same objects for as long as no file changes.

    What is made of them (`core/poses/part_pools`) is kept by the objects: asked again, it is at hand.

    Raises:
        InputError: There is none.
    """
    files = sorted(file for folder in registry.folders() if folder.is_dir() for file in folder.glob("*.json"))
    stats = [(file, file.stat()) for file in files]
    return _libraries(tuple((file, stat.st_mtime_ns, stat.st_size) for file, stat in stats))


@lru_cache(maxsize=1)
def _libraries(_files: tuple[tuple[Path, int, int], ...]) -> Sequence[Library]:
    """All registered libraries, read from files of these times and sizes."""
    return find_libraries(EVERY_LIBRARY, registry.folders())


def write_to_registry(libraries: Iterable[Library]) -> None:
    """Write libraries into the user's folder.

    Raises:
        InputError: The file of that name holds another library, or no library.
        ConversionError: A file cannot be written.
    """
    files = [(_own_file(registry.own_folder(), library.identifier), library) for library in libraries]
    for file, library in files:
        write_library(file, library)


def _own_file(folder: Path, identifier: str) -> Path:
    """The file of a library in a folder, new or existing: people may have put files there under any name."""
    path, there = library_path(folder, identifier), registered_libraries([folder])
    found = next((each.path for each in there if each.content and identifier_of(each) == identifier), path)
    other = next((each for each in there if each.path == found and identifier_of(each) != identifier), None)
    damaged = next((each for each in there if each.path == found and each.content is None), None)
    if other is not None or damaged is not None:
        held = "something that is no library" if other is None else f"the library '{other.title}'"
        raise InputError(f"{found}: holds {held}, which would be lost; give that file another name first")
    return found
