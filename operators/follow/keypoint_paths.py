"""Where a take's keypoint files are on disk, and whether they are as they were."""

from pathlib import Path
from time import monotonic

import bpy

from ..bridge.track_keypoints import file_state

LOOKED_S = 2.0
"""Time for which a file's state on disk is taken to be what it was: drawing reads no folder each time."""

_states: dict[Path, tuple[float, str | None]] = {}
"""Time at which a path was looked at [s], and the state it had."""


def recent_state(path: Path) -> str | None:
    """A file's state as of a moment ago (see `file_state`); None where it is missing."""
    now = monotonic()
    looked, state = _states.get(path, (-LOOKED_S, None))
    if now - looked >= LOOKED_S:
        state = file_state(path)
        _states[path] = now, state
    return state


def forget_states() -> None:
    """Look at every file anew."""
    _states.clear()


def keypoint_path(entry: bpy.types.PropertyGroup) -> Path:
    """The path of a file of keypoints, which may be missing.

    Blender keeps relative paths of its own in step when a .blend is saved elsewhere, those of extensions not:
    so the one from the root is used where nothing, or another file, lies at the relative one.
    """
    relative, absolute = Path(bpy.path.abspath(entry.filepath)), Path(entry.absolute_path)
    if not entry.absolute_path or relative == absolute:
        return relative
    state = recent_state(relative)
    if state is None or (state != entry.contents and recent_state(absolute) == entry.contents):
        return absolute if recent_state(absolute) is not None else relative
    return relative


def set_keypoint_path(entry: bpy.types.PropertyGroup, path: Path) -> None:
    """Set the path of a file of keypoints, and note its state."""
    from ...core.files.paths import real_path
    from ..bridge.footage_to_scene import stored_path

    entry.filepath = stored_path(path)
    entry.absolute_path = str(real_path(path))
    entry.contents = file_state(path) or ""


def add_keypoint_file(take: bpy.types.PropertyGroup, path: Path, replace: bool = False) -> None:
    """Add a file of keypoints to a take, switched on and chosen; one that it has is not added twice.

    Args:
        take: The take.
        path: The file or folder.
        replace: Whether it takes the place of the chosen one.
    """
    follow = take.follow
    known = [keypoint_path(entry) for entry in follow.files]
    if path in known:
        follow.active_file = known.index(path)
    elif not (replace and follow.active_file < len(follow.files)):
        follow.files.add()
        follow.active_file = len(follow.files) - 1
    entry = follow.files[follow.active_file]
    entry.is_used = True
    set_keypoint_path(entry, path)
