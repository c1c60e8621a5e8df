"""Library files: one JSON object, readable by people and validated as untrusted input.

`docs/library_format.md` describes the fields. Writing a library that was read gives the same bytes.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..body.human import HUMAN
from ..body.posture_fields import posture_to_json
from ..errors import InputError
from ..files.digest import digest
from ..files.fields import Fields
from ..files.json_file import read_json, shown
from ..files.json_layout import write_readable_json
from .library import Library, LibraryMotion, LibraryPosture
from .library_fields import read_library_fields

SCHEMA = "keymark-library"
SCHEMA_VERSION = 1
LARGEST_BYTES = 4 * 2**20
DECIMALS = 9
"""Nanometers and nanoradians: Blender's single precision survives."""


def read_library(path: Path) -> Library:
    """Read a library file.

    Raises:
        InputError: The file is missing, no library, or invalid.
    """
    return library_from_json(read_json(path, LARGEST_BYTES), str(path))


def write_library(path: Path, library: Library) -> None:
    """Write a library file, whole or not at all.

    Raises:
        InputError: The library is invalid and could not be read back.
        ConversionError: The file cannot be written.
    """
    value = library_to_json(library)
    library_from_json(value, f"library {shown(library.identifier)}")
    write_readable_json(path, value)


def library_from_json(value: Any, where: str) -> Library:
    """Read a library from JSON that is not trusted; the inverse of `library_to_json`.

    Raises:
        InputError: The JSON is no valid library; `where` begins the sentence.
    """
    fields = Fields.of(value, where)
    schema = fields.values.get("schema")
    if schema != SCHEMA:
        raise InputError(f'{where}: schema is {shown(schema)}; a keyframe library has "{SCHEMA}" there')
    fields.check_version(SCHEMA_VERSION)
    return read_library_fields(fields, HUMAN)


def library_to_json(library: Library) -> dict[str, Any]:
    """A library as a JSON object, its fields in the order of the file, without empty ones."""
    value: dict[str, Any] = {
        "schema": SCHEMA,
        "schema_version": SCHEMA_VERSION,
        "identifier": library.identifier,
        "title": library.title,
        "version": library.version,
        "author": library.author,
        "license": library.license,
        "description": library.description,
        "tags": list(library.tags),
        "sources": list(library.sources),
        "actor": {"segments_m": {name: _number(m) for name, m in library.actor.segments_m.items()}},
        "motions": [_motion(motion) for motion in library.motions],
        "postures": [_posture(posture) for posture in library.postures],
    }
    return _without_empty(value, ("description", "tags", "sources", "motions"))


def library_digest(library: Library) -> str:
    """Digest of a library's content, whatever the path and the layout of its file."""
    return digest(json.dumps(library_to_json(library), sort_keys=True))


def _motion(motion: LibraryMotion) -> dict[str, Any]:
    value: dict[str, Any] = {
        "name": motion.name,
        "cyclic": motion.cyclic,
        "duration_s": _number(motion.duration_s),
    }
    travel = [_number(part) for part in motion.travel]
    if any(travel):
        value["travel"] = dict(zip(("x_m", "y_m", "heading_rad"), travel, strict=True))
    value["steps"] = [{"time_s": _number(step.time_s), "posture": step.posture} for step in motion.steps]
    return value


def _posture(posture: LibraryPosture) -> dict[str, Any]:
    values = posture_to_json(posture.posture, DECIMALS)
    moved = {name: number for name, number in values.items() if number != 0.0}
    return _without_empty({"name": posture.name, "tags": list(posture.tags), "posture": moved}, ("tags",))


def _number(value: float) -> float:
    return round(float(value), DECIMALS) + 0.0  # no negative zero


def _without_empty(value: dict[str, Any], names: Sequence[str]) -> dict[str, Any]:
    return {name: item for name, item in value.items() if item or name not in names}
