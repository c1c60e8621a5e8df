"""MMPose's result files: `instances` of every frame, under `instance_info` or as a plain list."""

from typing import Any

import numpy as np

from ...errors import InputError
from ...files.json_file import shown
from .detected_frames import (
    FARTHEST_PX,
    DetectedFrames,
    DetectedPerson,
    check_people,
    person_array,
    same_layout,
)
from .layouts import Layout

INFO = "instance_info"


def is_mmpose(value: Any) -> bool:
    """Whether a JSON value is of this format."""
    if isinstance(value, dict):
        return isinstance(value.get(INFO), list)
    return isinstance(value, list) and bool(value) and isinstance(value[0], dict) and "instances" in value[0]


def is_instances(value: Any) -> bool:
    """Whether a JSON value is a list of people, as one frame has them; nobody is one too."""
    return isinstance(value, list) and all(
        isinstance(one, dict) and {"keypoints", "keypoint_scores"} <= set(one) for one in value
    )


def instance_people(instances: list[Any], where: str) -> list[DetectedPerson]:
    """The people of one frame.

    Raises:
        InputError: An entry has no points in the picture.
    """
    return [_person(instance, f"{where}[{index}]") for index, instance in enumerate(instances)]


def read_mmpose(value: Any, where: str, source: str) -> DetectedFrames:
    """Read MMPose's results of a video.

    Args:
        value: The file's value.
        where: The file.
        source: Name of what saw them.

    Raises:
        InputError: An entry is something else, or the file has one picture's people only.
    """
    entries = value[INFO] if isinstance(value, dict) else value
    place = f"{where}: {INFO}" if isinstance(value, dict) else f"{where}: "
    if not entries:
        raise InputError(f"{where}: {INFO} is empty; it must have an entry for every frame")
    layout: Layout | None = None
    people: dict[int, tuple[DetectedPerson, ...]] = {}
    numbered = isinstance(entries[0], dict) and "frame_id" in entries[0]
    for index, entry in enumerate(entries):
        spot = f"{place}[{index}]"
        instances = entry.get("instances") if isinstance(entry, dict) else None
        if not isinstance(instances, list):
            raise InputError(f"{spot} is {shown(entry)}; it must be an object with a list of instances")
        number = _number(entry, spot) if numbered else index
        if number in people:
            raise InputError(f"{spot}.frame_id is {number}, which stands twice; each frame must stand once")
        check_people(len(instances), f"{spot}.instances")
        seen = instance_people(instances, f"{spot}.instances")
        for one, person in enumerate(seen):
            layout = same_layout(layout, len(person.place), f"{spot}.instances[{one}].keypoints")
        people[number] = tuple(seen)
    if layout is None:
        raise InputError(
            f"{where}: nobody is seen in any of its {len(people)} frames; one must show a person"
        )
    return DetectedFrames(where, source, layout, people, numbered=numbered)


def _number(entry: dict[str, Any], spot: str) -> int:
    number = entry.get("frame_id")
    if not isinstance(number, int) or isinstance(number, bool) or number < 0:
        raise InputError(f"{spot}.frame_id is {shown(number)}; it must be the frame's number")
    return number


def _person(instance: Any, spot: str) -> DetectedPerson:
    if not isinstance(instance, dict):
        raise InputError(
            f"{spot} is {shown(instance)}; it must be an object with keypoints and keypoint_scores"
        )
    points = instance.get("keypoints")
    if isinstance(points, list) and points and isinstance(points[0], list) and len(points[0]) == 3:
        raise InputError(
            f"{spot}.keypoints has points in space; it must have [x, y] in pixels, the result of a 2D model"
        )
    place = person_array(points, (-1, 2), FARTHEST_PX, f"{spot}.keypoints")
    scores = instance.get("keypoint_scores")
    if scores is None:
        return DetectedPerson(place, np.ones(len(place)))
    return DetectedPerson(place, person_array(scores, (len(place),), FARTHEST_PX, f"{spot}.keypoint_scores"))
