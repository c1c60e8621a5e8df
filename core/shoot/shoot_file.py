"""`shoot.json`: what all takes below its folder have in common."""

import os
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..files.fields import Fields
from ..files.inherited import COMMENT
from ..files.json_file import read_json, shown

NAME = "shoot.json"
SCHEMA_VERSION = 1
LARGEST_BYTES = 2**20
SHARED = ("fps", "frame_start", "camera", "markers", "actor")
"""Fields of `take.json` that takes may inherit."""
SETTINGS = ("library", "floor_m", "method", "pictures")
"""Fields that say how takes are converted."""
OWN = ("$schema", "schema_version", "root")
"""Fields that say something of the file itself; an editor looks for the first."""
KNOWN = (*OWN, *SHARED, *SETTINGS)


def read_shoot_file(path: Path) -> dict[str, Any]:
    """The fields of one `shoot.json`; what they hold is checked where a take uses them.

    Raises:
        InputError: The file is unusable, of a newer Keymark, or has a field that is not known.
    """
    values = read_json(path, LARGEST_BYTES)
    fields = Fields(values, str(path))
    fields.refuse_others([*KNOWN, *(name for name in values if name.startswith(COMMENT))])
    if fields.has("schema_version"):
        fields.check_version(SCHEMA_VERSION)
    if not isinstance(values.get("root", False), bool):
        raise InputError(f"{path}: root is {shown(values['root'])}; it must be true or false")
    return {name: value for name, value in values.items() if name not in OWN}


def shoot_files(folder: Path) -> list[Path]:
    """Every `shoot.json` that takes in a folder inherit from, the farthest first.

    They are looked for in the folder and all above it, up to one that says `"root": true`. Whatever is called
    so counts: what a broken link or a folder of that name was to say is not left out in silence.

    Raises:
        InputError: One that is found cannot be read.
    """
    found: list[Path] = []
    whole = whole_way(folder)
    for place in (whole, *whole.parents):
        file = place / NAME
        if os.path.lexists(file):
            found.append(file)
            if read_json(file, LARGEST_BYTES).get("root") is True:
                break
    return found[::-1]


def whole_way(path: Path) -> Path:
    """A path from the root, none of whose parents is a way back: those of `/day1/../day2` name `day1`."""
    return Path(os.path.realpath(path)) if ".." in path.parts else path.absolute()
