"""`shoot.json`: what all takes below its folder have in common."""

import os
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..files.fields import Fields
from ..files.inherited_fields import COMMENT_PREFIX
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


def shoot_fields(path: Path, values: dict[str, Any]) -> dict[str, Any]:
    """What one `shoot.json` says of takes; what the fields hold is checked where a take uses them.

    Args:
        path: The file, for sentences.
        values: All that stands in it, as `shoot_files` gives it.

    Raises:
        InputError: It is of a newer Keymark, or has a field that is not known.
    """
    fields = Fields(values, str(path))
    fields.refuse_others([*KNOWN, *(name for name in values if name.startswith(COMMENT_PREFIX))])
    if fields.has("schema_version"):
        fields.check_version(SCHEMA_VERSION)
    if not isinstance(values.get("root", False), bool):
        raise InputError(f"{path}: root is {shown(values['root'])}; it must be true or false")
    return {name: value for name, value in values.items() if name not in OWN}


def shoot_files(folder: Path) -> dict[Path, dict[str, Any]]:
    """Every `shoot.json` that takes in a folder inherit from, with all that stands in it, the farthest first.

    They are looked for in the folder and all above it, up to one that says `"root": true`. Whatever is called
    so counts: what a broken link or a folder of that name was to say is not left out in silence.

    Raises:
        InputError: One that is found cannot be read.
    """
    found: dict[Path, dict[str, Any]] = {}
    whole = whole_way(folder)
    for place in (whole, *whole.parents):
        file = place / NAME
        if os.path.lexists(file):
            found[file] = read_json(file, LARGEST_BYTES)
            if found[file].get("root") is True:
                break
    return dict(reversed(found.items()))


def whole_way(path: Path) -> Path:
    """A path from the root, none of whose parents is a way back: those of `/day1/../day2` name `day1`."""
    return Path(os.path.realpath(path)) if ".." in path.parts else path.absolute()
