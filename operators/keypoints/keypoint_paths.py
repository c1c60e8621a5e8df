"""Where a take's keypoint files are on disk."""

from pathlib import Path

import bpy

from ..bridge.keypoint_files import file_state


def keypoint_path(entry: bpy.types.PropertyGroup) -> Path:
    """The path of a file of keypoints, which may be missing.

    Blender keeps relative paths of its own in step when a .blend is saved elsewhere, those of extensions not:
    so the one from the root is used where nothing, or another file, lies at the relative one.
    """
    relative, absolute = Path(bpy.path.abspath(entry.filepath)), Path(entry.absolute_path)
    if not entry.absolute_path or relative == absolute:
        return relative
    state = file_state(relative)
    if state is None or (state != entry.contents and file_state(absolute) == entry.contents):
        return absolute if file_state(absolute) is not None else relative
    return relative


def set_keypoint_path(entry: bpy.types.PropertyGroup, path: Path) -> None:
    """Set the path of a file of keypoints, and note its state."""
    from ...core.files.paths import real_path
    from ..bridge.footage_to_scene import stored_path

    entry.filepath = stored_path(path)
    entry.absolute_path = str(real_path(path))
    entry.contents = file_state(path) or ""
