"""Library files: one JSON object, readable by people and validated as untrusted input.

Writing a library that was read gives the same bytes.
"""

import json
from pathlib import Path

from ..files.digest import digest
from ..files.json_file import read_json, shown
from ..files.json_layout import write_readable_json
from .library import Library

LARGEST_BYTES = 4 * 2**20


def read_library(path: Path) -> Library:
    """Read a library file.

    Raises:
        InputError: The file is missing, no library, or invalid.
    """
    return Library.from_json(read_json(path, LARGEST_BYTES), str(path))


def write_library(path: Path, library: Library) -> None:
    """Write a library file, whole or not at all.

    Raises:
        InputError: The library is invalid and could not be read back.
        ConversionError: The file cannot be written.
    """
    value = library.to_json()
    Library.from_json(value, f"library {shown(library.identifier)}")
    write_readable_json(path, value)


def library_digest(library: Library) -> str:
    """Digest of a library's content, whatever the path and the layout of its file."""
    return digest(json.dumps(library.to_json(), sort_keys=True))
