"""A take's keypoint files as panels and overlays show them, read when they are first needed.

A file that cannot be read is remembered with its sentence, so that drawing does not try again and again.
"""

from dataclasses import dataclass

import bpy
import numpy as np

from ...core.errors import InputError
from ...core.footage.keypoints.people import People
from ..bridge.keypoint_files import read_keypoint_file
from ..shell.lru_cache import LruCache
from ..shell.takes import footage_of
from .keypoint_paths import forget_states, keypoint_path, recent_state

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


def keypoint_reading(take: bpy.types.PropertyGroup, entry: bpy.types.PropertyGroup) -> KeypointReading:
    """What a file of a take's keypoints says, or why it says nothing."""
    path = keypoint_path(entry)
    state = recent_state(path)
    footage = footage_of(take.id_data, take)
    size = (take.clip.size[0], take.clip.size[1]) if take.clip is not None else (0, 0)
    key = f"{path} {state} {size} {entry.contents}"

    def read() -> KeypointReading:
        try:
            people = read_keypoint_file(path, None, size, footage.rate, footage.first_frame)
        except InputError as error:
            sentence = str(error).replace(str(path), path.name)
            return KeypointReading(None, sentence, is_missing=state is None)
        hints = any(bool(np.isfinite(frame.hint_m).any()) for frame in people.frames)
        return KeypointReading(people, has_changed=state != entry.contents, has_hints=hints)

    return _readings.get(key, read) or KeypointReading(None)


def clear_readings() -> None:
    """Look at every file anew."""
    _readings.clear()
    forget_states()
