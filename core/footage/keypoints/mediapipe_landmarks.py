"""MediaPipe's landmarks dumped as JSON: objects with x, y, z and visibility, for every frame of a clip.

The coordinates are shares of the picture. A frame is a list of landmarks or of people's lists, or an object
that holds them as `landmarks` or `pose_landmarks`, and the network's guess in space as `worldLandmarks` or
`pose_world_landmarks`, with or without capitals and underscores. A dump of a message has them in `landmark`.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...arrays import Array
from ...errors import InputError
from ...files.json_file import shown
from .detected_frames import (
    FARTHEST_M,
    FARTHEST_PX,
    DetectedFrames,
    DetectedPerson,
    check_people,
    person_array,
)
from .layouts import LAYOUTS

LAYOUT = LAYOUTS["blazepose33"]
IMAGE = ("landmarks", "poselandmarks")
WORLD = ("worldlandmarks", "poseworldlandmarks")
"""Names of the two lists, without capitals and underscores."""


def is_mediapipe(value: Any) -> bool:
    """Whether a JSON value is of this format: its first frame that is not empty has landmarks."""
    frames = value.get("frames") if isinstance(value, dict) else value
    if not isinstance(frames, list):
        return False
    first = next((frame for frame in frames if frame), None)
    if isinstance(first, Mapping):
        return _field(first, IMAGE) is not None or "landmark" in first
    while isinstance(first, list) and first:
        first = first[0]
    return isinstance(first, Mapping) and {"x", "y"} <= set(first)


def read_mediapipe(value: Any, where: str, source: str) -> DetectedFrames:
    """Read a list of frames, or an object with one as `frames`.

    Args:
        value: The file's value.
        where: The file.
        source: Name of what saw them.

    Raises:
        InputError: A frame is something else.
    """
    frames = value["frames"] if isinstance(value, dict) else value
    people = {}
    for index, frame in enumerate(frames):
        people[index] = _people(frame, f"{where}: [{index}]")
    return DetectedFrames(where, source, LAYOUT, people, numbered=False, shares=True)


def _people(frame: Any, spot: str) -> tuple[DetectedPerson, ...]:
    world = None
    if isinstance(frame, Mapping) and "landmark" not in frame:
        world = _field(frame, WORLD)
        frame = _field(frame, IMAGE)
    people = _lists(frame, spot)
    guesses = _lists(world, spot)
    check_people(len(people), spot)
    if guesses and len(guesses) != len(people):
        raise InputError(
            f"{spot} has {len(guesses)} world landmarks for {len(people)} people; it must have one each"
        )
    seen = []
    for index, landmarks in enumerate(people):
        place = _numbers(landmarks, ("x", "y"), FARTHEST_PX, spot)
        score = _scores(landmarks, spot)
        hint = _numbers(guesses[index], ("x", "y", "z"), FARTHEST_M, spot) if guesses else None
        seen.append(DetectedPerson(place, score, hint))
    return tuple(seen)


def _field(frame: Mapping[str, Any], names: tuple[str, ...]) -> Any:
    """The field of one of these names, written with or without capitals and underscores."""
    for name, value in frame.items():
        if name.replace("_", "").lower() in names:
            return value
    return None


def _lists(value: Any, spot: str) -> list[list[Any]]:
    """Everyone's landmarks: one person's list, several people's lists, or messages with a list each."""
    if isinstance(value, Mapping):
        value = value.get("landmark")
    if not value:
        return []
    if not isinstance(value, list):
        raise InputError(f"{spot} is {shown(value)}; it must be a list of landmarks or null")
    single = isinstance(value[0], Mapping) and "landmark" not in value[0]
    people = [value] if single else [one["landmark"] if _is_message(one) else one for one in value]
    for landmarks in people:
        points = isinstance(landmarks, list) and all(isinstance(point, Mapping) for point in landmarks)
        if not points or len(landmarks) != LAYOUT.count:
            raise InputError(
                f"{spot} has {shown(landmarks)}; each person must have the {LAYOUT.count} landmarks of "
                "MediaPipe's Pose, {x, y, z, visibility} each"
            )
    return people


def _is_message(value: Any) -> bool:
    return isinstance(value, Mapping) and "landmark" in value


def _numbers(landmarks: list[Any], axes: tuple[str, ...], farthest: float, spot: str) -> Array:
    rows = [[point.get(axis) for axis in axes] for point in landmarks]
    return person_array(rows, (LAYOUT.count, len(axes)), farthest, f"{spot} ({', '.join(axes)})")


def _scores(landmarks: list[Any], spot: str) -> Array:
    """(N,) the visibilities; 1 where none is given."""
    if not any("visibility" in point for point in landmarks):
        return np.ones(LAYOUT.count)
    rows = [point.get("visibility", 0.0) for point in landmarks]
    return person_array(rows, (LAYOUT.count,), FARTHEST_PX, f"{spot} (visibility)")
