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


def named_libraries(name: str) -> Sequence[Library]:
    """All libraries where `EVERY_LIBRARY` or nothing is named, else that of an identifier, title or file."""
    return all_libraries() if name in ("", EVERY_LIBRARY) else [load_registered(name)]


def all_libraries() -> Sequence[Library]:
    """All registered libraries, the same objects until a file changes: what is made of them stays known."""
    files = sorted(file for folder in registry.folders() if folder.is_dir() for file in folder.glob("*.json"))
    stats = [(file, file.stat()) for file in files]
    return _libraries(tuple((file, stat.st_mtime_ns, stat.st_size) for file, stat in stats))


@lru_cache(maxsize=1)
def _libraries(_files: tuple[tuple[Path, int, int], ...]) -> Sequence[Library]:
    """All registered libraries, read from files of these times and sizes."""
    return find_libraries(EVERY_LIBRARY, registry.folders())


def write_to_registry(libraries: Iterable[Library]) -> None:
    """Write libraries into the user's folder; InputError where that would lose a file of another content."""
    folder = registry.own_folder()
    there = registered_libraries([folder])
    files = []
    for library in libraries:  # people may have put files there under any name
        name = library.identifier
        own = [entry.path for entry in there if entry.content and identifier_of(entry) == name]
        path = own[0] if own else library_path(folder, name)
        other = next((entry for entry in there if entry.path == path and path not in own), None)
        if other is not None:
            held = f"the library '{other.title}'" if other.content else "something that is no library"
            raise InputError(f"{path}: holds {held}, which would be lost; give that file another name first")
        files.append((path, library))
    for path, library in files:
        write_library(path, library)
