"""`shoot.json`: fields that all takes below its folder inherit."""

import os
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..files.fields import Fields
from ..files.inherited_fields import COMMENT_PREFIX
from ..files.json_file import read_json, shown
from ..files.paths import absolute_path
from ..files.records import check_version
from ..library.several_libraries import EVERY_LIBRARY

SHOOT_FILE = "shoot.json"
SCHEMA_VERSION = 1
LARGEST_BYTES = 2**20
SHARED_FIELDS = ("fps", "frame_start", "camera", "markers", "ignored_regions", "actor")
"""Fields of `take.json` that takes may inherit."""
SETTING_FIELDS = ("library", "floor_m", "method", "pictures", "character", "keypoints", "evidence")
"""Fields that say how takes are converted."""
FILE_FIELDS = ("$schema", "schema_version", "root")
"""Fields about the file itself; editors read the first."""
KEYFRAMES = "keyframes"
"""Field of `take.json` that may say `EVERY_LIBRARY` here, and nothing else."""
KNOWN_FIELDS = (*FILE_FIELDS, *SHARED_FIELDS, KEYFRAMES, *SETTING_FIELDS)


def shoot_fields(path: Path, values: dict[str, Any]) -> dict[str, Any]:
    """The fields of one `shoot.json` that takes inherit; their values are checked where a take uses them.

    Args:
        path: The file, for sentences.
        values: All its fields, as `find_shoot_files` gives them.

    Raises:
        InputError: The file is of a newer Keymark, has an unknown field, or names a keyframe file.
    """
    fields = Fields(values, str(path))
    fields.refuse_others([*KNOWN_FIELDS, *(name for name in values if name.startswith(COMMENT_PREFIX))])
    if fields.has("schema_version"):
        check_version(fields, SCHEMA_VERSION)
    if not isinstance(values.get("root", False), bool):
        raise InputError(f"{path}: root is {shown(values['root'])}; it must be true or false")
    if values.get(KEYFRAMES) not in (None, EVERY_LIBRARY):
        raise InputError(
            f"{path}: keyframes is {shown(values[KEYFRAMES])}; for all takes below it must be "
            f"{EVERY_LIBRARY}, which finds keyframes with all libraries: a keyframe file is a take's own"
        )
    return {name: value for name, value in values.items() if name not in FILE_FIELDS}


def find_shoot_files(folder: Path) -> dict[Path, dict[str, Any]]:
    """Every `shoot.json` that takes in a folder inherit from, with all its fields, the farthest first.

    They are searched in the folder and all its parents, up to one that says `"root": true`. A broken link or
    a folder of that name is an error: what it was to say is not left out in silence.

    Raises:
        InputError: One that is found cannot be read.
    """
    found: dict[Path, dict[str, Any]] = {}
    start = absolute_path(folder)
    for parent in (start, *start.parents):
        file = parent / SHOOT_FILE
        if os.path.lexists(file):
            found[file] = read_json(file, LARGEST_BYTES)
            if found[file].get("root") is True:
                break
    return dict(reversed(found.items()))
