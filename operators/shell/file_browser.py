"""Asking for a file: the browser opens where it was left, and a choice of nothing is said in a sentence."""

import os
from pathlib import Path

import bpy

from ...core.errors import InputError

SEPARATORS = ("/", os.sep)

_folders: dict[str, str] = {}  # folder that each operator's browser was left in, for this session


def browse(operator: bpy.types.Operator, context: bpy.types.Context, folder: str = "") -> set[str]:
    """Show the file browser where this operator's was left last, first in `folder`; returns as `invoke`."""
    begin = _folders.get(operator.bl_idname, folder)
    if begin:
        operator.filepath = os.path.join(begin, "")
    context.window_manager.fileselect_add(operator)
    return {"RUNNING_MODAL"}


def chosen_path(operator: bpy.types.Operator) -> Path:
    """The path that an operator got from its browser or a script; the folder is kept for the next time."""
    path = Path(bpy.path.abspath(operator.filepath))
    if operator.filepath:
        _folders[operator.bl_idname] = str(path if path.is_dir() else path.parent)
    return path


def chosen_file(operator: bpy.types.Operator, wanted: str) -> Path:
    """The file that an operator got, as `chosen_path`; a script may name a folder of images.

    Raises:
        InputError: Nothing was chosen: a browser then gives its folder and a separator. `wanted` says what
            would be valid.
    """
    path = chosen_path(operator)
    if not operator.filepath:
        raise InputError(f"no file is chosen; choose {wanted}")
    if operator.filepath.endswith(SEPARATORS):
        raise InputError(f"no file is chosen in {path}; choose {wanted}")
    return path


def is_browsing(operator: bpy.types.Operator, manager: bpy.types.WindowManager) -> bool:
    """Whether a modal operator waits for its file browser alone, in whichever window that is."""
    areas = (area for window in manager.windows for area in window.screen.areas)
    asking = (area.spaces.active.active_operator for area in areas if area.type == "FILE_BROWSER")
    return any(each is not None and each.as_pointer() == operator.as_pointer() for each in asking)
