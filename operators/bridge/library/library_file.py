"""Keyframe libraries in files, by their suffix: .json, or .blend with pose assets."""

from pathlib import Path

from ....core.errors import InputError
from ....core.library.library import Library
from ....core.library.library_file import read_library, write_library
from .library_blend import read_library_blend, write_library_blend

JSON, BLEND = ".json", ".blend"


def read_libraries(path: Path) -> tuple[Library, ...]:
    """The libraries of a file: one in a .json, one or more in a .blend.

    Raises:
        InputError: The file is of another kind, or unusable.
    """
    suffix = path.suffix.lower()
    if suffix == BLEND:
        return read_library_blend(path)
    if suffix == JSON:
        return (read_library(path),)
    raise InputError(f"{path}: is neither a .json nor a .blend; libraries are kept in these")


def write_library_file(path: Path, library: Library, root: Path) -> None:
    """Write a library in the format of the file's suffix.

    Args:
        path: The file.
        library: The library.
        root: Folder of the asset library that a .blend lies in.

    Raises:
        InputError: The file is of another kind, or the library is incomplete.
        ConversionError: The file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix == BLEND:
        write_library_blend(path, library, root)
    elif suffix == JSON:
        write_library(path, library)
    else:
        raise InputError(f"{path}: ends in {(suffix or 'nothing')}; libraries are written as .json or .blend")
