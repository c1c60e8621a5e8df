"""Character map files: one JSON object, readable by people and validated as untrusted input.

`docs/character_map_format.md` describes the fields. Writing a map that was read gives the same bytes.
"""

import json
from pathlib import Path

from ...files.digest import digest
from ...files.json_file import read_json, shown
from ...files.json_layout import write_readable_json
from .character_map import CharacterMap

LARGEST_BYTES = 2**20


def read_character_map(path: Path) -> CharacterMap:
    """Read a character map file.

    Raises:
        InputError: The file is missing, no character map, or invalid.
    """
    return CharacterMap.from_json(read_json(path, LARGEST_BYTES), str(path))


def write_character_map(path: Path, character_map: CharacterMap) -> None:
    """Write a character map file, whole or not at all.

    Raises:
        InputError: The map is invalid and could not be read back.
        ConversionError: The file cannot be written.
    """
    value = character_map.to_json()
    CharacterMap.from_json(value, f"character map {shown(character_map.title)}")
    write_readable_json(path, value)


def map_digest(character_map: CharacterMap) -> str:
    """Digest of a map's content, whatever the path and the layout of its file."""
    return digest(json.dumps(character_map.to_json(), sort_keys=True))
