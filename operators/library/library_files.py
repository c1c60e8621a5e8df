"""The folder of the user's own keyframe libraries."""

from pathlib import Path

import bpy

from ..shell.results import EXTENSION

OWN = "libraries"  # Name of the folder


def own_folder() -> Path:
    """Folder of the user's libraries; created if missing."""
    try:
        return Path(bpy.utils.extension_path_user(EXTENSION, path=OWN, create=True))
    except ValueError:  # not installed as an extension
        folder = Path(bpy.app.tempdir) / OWN
        folder.mkdir(parents=True, exist_ok=True)
        return folder
