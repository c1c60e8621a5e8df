"""A take's keypoint files as panels and overlays show them, read when they are first needed.

A file that cannot be read is remembered with its sentence, so that drawing does not try again and again.
"""

from dataclasses import dataclass
from pathlib import Path
from time import monotonic

import bpy
import numpy as np

from ...core.errors import InputError
from ...core.footage.keypoints.people import People
from ..bridge.keypoint_files import file_state, read_keypoint_file
from ..shell.lru_cache import LruCache
from ..shell.takes import footage_of
from .keypoint_paths import keypoint_path

LOOKED_S = 2.0
"""Time for which a file's state on disk is taken to be what it was, so that drawing reads no folder."""
MOST_FILES = 12


@dataclass(frozen=True, eq=False)
class KeypointReading:
    """A file of keypoints as it is on disk."""

    people: People | None
    """Everyone in it, frame by frame of the file; None where it cannot be read."""
    problem: str = ""
    """Why it cannot be read, for people."""
    is_missing: bool = False
    has_changed: bool = False
    """Whether it has been written since it was loaded."""
    has_hints: bool = False
    """Whether it guesses depths."""


_readings: LruCache[KeypointReading] = LruCache(MOST_FILES)
_states: dict[Path, tuple[float, str | None]] = {}
"""Time at which a path was looked at [s], and the state it had."""


def keypoint_reading(take: bpy.types.PropertyGroup, entry: bpy.types.PropertyGroup) -> KeypointReading:
    """What a file of a take's keypoints says, or why it says nothing."""
    path = keypoint_path(entry)
    state = _state(path)
    footage = footage_of(take.id_data, take)
    size = (take.clip.size[0], take.clip.size[1]) if take.clip is not None else (0, 0)
    key = f"{path} {state} {size} {entry.contents}"

    def read() -> KeypointReading:
        try:
            people = read_keypoint_file(path, None, size, footage.rate, footage.first_frame)
        except InputError as error:
            return KeypointReading(None, str(error), is_missing=state is None)
        hints = any(bool(np.isfinite(frame.hint_m).any()) for frame in people.frames)
        return KeypointReading(people, has_changed=state != entry.contents, has_hints=hints)

    return _readings.get(key, read) or KeypointReading(None)


def clear_readings() -> None:
    """Look at every file anew."""
    _readings.clear()
    _states.clear()


def _state(path: Path) -> str | None:
    now = monotonic()
    looked, state = _states.get(path, (-LOOKED_S, None))
    if now - looked >= LOOKED_S:
        state = file_state(path)
        _states[path] = now, state
    return state
