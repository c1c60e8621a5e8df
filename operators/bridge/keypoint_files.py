"""Keypoint files of a clip, each parsed once a session as long as it stays the same on disk."""

import os
from functools import lru_cache
from operator import itemgetter
from pathlib import Path
from stat import S_ISDIR

from ...core.errors import InputError
from ...core.files.digest import digest
from ...core.footage.keypoints.people import People

MOST_FILES = 12
"""Files that are remembered: those of the takes at hand, for a job and for panels."""


def read_keypoint_file(
    path: Path, frame_count: int | None, size: tuple[int, int], fps: float, frame_start: int
) -> People:
    """Everyone whom a file of keypoints, or a folder with a file a frame, says was seen.

    Args:
        path: The file or folder.
        frame_count: Number of the clip's frames F; None where it is not known.
        size: Width and height of the clip [px].
        fps: Frames per second of the clip.
        frame_start: Scene frame of its first one.

    Raises:
        InputError: The file is missing or unusable, or it cannot be one of this clip.
    """
    state = file_state(path)
    if state is None:
        raise InputError(f"{path}: the keypoints are not there; load them from where they are now")
    return _read(path, state, frame_count, size, fps, frame_start)


def file_state(path: Path) -> str | None:
    """A digest that changes when a file, or any file of a folder, is written; None where it is missing."""
    try:
        found = os.stat(path)
        if not S_ISDIR(found.st_mode):
            return digest(found.st_size, found.st_mtime_ns)
        with os.scandir(path) as entries:
            states = sorted(((entry.name, entry.stat()) for entry in entries), key=itemgetter(0))
    except (OSError, ValueError):
        return None
    return digest(tuple((name, state.st_size, state.st_mtime_ns) for name, state in states))


@lru_cache(maxsize=MOST_FILES)
def _read(
    path: Path, state: str, frame_count: int | None, size: tuple[int, int], fps: float, frame_start: int
) -> People:
    from ...core.footage.keypoints.keypoint_file import read_keypoints

    return read_keypoints(path, frame_count, size, fps, frame_start)
