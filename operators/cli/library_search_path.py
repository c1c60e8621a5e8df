"""Keyframe libraries as the command line knows them: by name where they lie on the shelf, or by file."""

import os
import sys
from pathlib import Path

from ....core.library.registry import SHIPPED
from ..line_parser import UsageError

VARIABLE = "KEYMARK_LIBRARIES"
"""Environment variable of further folders of libraries, apart as in PATH."""


def library_folders() -> list[Path]:
    """Where libraries are looked for; of two with the same identifier the first counts."""
    named = [Path(place) for place in os.environ.get(VARIABLE, "").split(os.pathsep) if place]
    blender = sys.modules.get("bpy")
    if blender is not None and blender.app.binary_path:  # a user's, who may have some of their own
        from ...library.registry import own_folder

        named.append(own_folder())
    return [*named, SHIPPED]


def refuse_existing(output: Path, replace: bool) -> None:
    """Refuse to write where something is already, unless that is wanted.

    Raises:
        UsageError: Something is there.
    """
    if output.exists() and not replace:
        raise UsageError(f"{output} is there already; name another file, or add --replace to replace it")
