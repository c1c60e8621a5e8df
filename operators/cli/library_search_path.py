"""The folders in which the command line finds libraries and character maps."""

import os
import sys
from pathlib import Path

from ...core.prior.library import Library
from ...core.prior.registry import SHIPPED, find_libraries

VARIABLE = "KEYMARK_LIBRARIES"
"""Environment variable with further folders of libraries and character maps, separated as in PATH."""


def library_folders() -> list[Path]:
    """The folders that are searched, in order; the first library with an identifier counts."""
    folders = [Path(folder) for folder in os.environ.get(VARIABLE, "").split(os.pathsep) if folder]
    blender = sys.modules.get("bpy")
    if blender is not None and blender.app.binary_path:  # where users keep libraries of their own
        from ..library.registry import own_folder

        folders.append(own_folder())
    return [*folders, SHIPPED]


def requested_libraries(wanted: str) -> tuple[Library, ...]:
    """The libraries that a setting means: one by name or file, or every usable one."""
    return find_libraries(wanted, library_folders())
