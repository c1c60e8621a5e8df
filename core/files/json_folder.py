"""A folder of JSON files that people share: keyframe libraries and character maps, side by side."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

ENDING = ".json"
MOST_FILES = 500
"""Files read of one folder; further ones are ignored."""
OURS = "keymark-"
"""Beginning of the field `schema` of every format that such folders hold."""


def json_files(folder: Path) -> list[Path]:
    """The JSON files in a folder, by name; none where it is missing."""
    try:
        files = [path for path in folder.iterdir() if path.suffix.lower() == ENDING and path.is_file()]
    except OSError:
        return []
    return sorted(files)[:MOST_FILES]


def is_path(name_or_path: str | Path) -> bool:
    """Whether a file is meant where names are valid too: it ends in `.json` or contains a path separator."""
    text = os.fspath(name_or_path)
    parted = any(mark in text for mark in (os.sep, os.altsep, "/") if mark)
    return isinstance(name_or_path, Path) or parted or text.lower().endswith(ENDING)


def is_other_format(value: Mapping[str, Any], schema: str) -> bool:
    """Whether a file is of another of our formats, and thus no damaged one of this."""
    own = value.get("schema")
    return isinstance(own, str) and own.startswith(OURS) and own != schema
