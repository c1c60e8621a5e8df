"""Detectors' JSON: OpenPose (rtmlib, Pose2Sim, Sports2D, pose nodes), COCO, MMPose and MediaPipe."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import InputError, shown
from .detected_frames import (
    FARTHEST_M,
    FARTHEST_PX,
    DetectedFrames,
    DetectedPerson,
    check_people,
    person_array,
    same_layout,
)
from .layouts import HAND_POINTS, LAYOUTS, Layout, with_hands
from .stated_frames import stated_frames

BODY, HANDS = "pose_keypoints_2d", ("hand_left_keypoints_2d", "hand_right_keypoints_2d")
OLD = "_2d"  # what names of lists did not end with before OpenPose 1.1


def is_openpose_frame(value: Any) -> bool:
    """Whether a JSON value is one frame of this format."""
    people = value.get("people") if isinstance(value, dict) else None
    return isinstance(people, list) and all(isinstance(person, dict) for person in people)


def openpose_people(value: Any, where: str) -> list[tuple[DetectedPerson, int]]:
    """The people of a frame, each with the number of its body's points.

    Where a hand was found, the 21 points of the left hand and those of the right follow the body's.
    """
    people = []
    for index, entry in enumerate(value["people"]):
        spot = f"{where}: people[{index}]"
        lists = {name: _list(entry, name) for name in (BODY, *HANDS)}
        body = points = _points(lists[BODY], f"{spot}.{BODY}")
        if not len(body):  # only a hand or a face was found
            continue
        hands = [_points(lists[name], f"{spot}.{name}") for name in HANDS]
        if any(len(hand) == HAND_POINTS for hand in hands):
            missing = np.zeros((HAND_POINTS, 3))
            points = np.concatenate([body, *(x if len(x) == HAND_POINTS else missing for x in hands)])
        people.append((DetectedPerson(points[:, :2], points[:, 2]), len(body)))
    return people


def _list(person: Mapping[str, Any], name: str) -> Any:
    found = person.get(name)
    found = person.get(name.removesuffix(OLD)) if found is None else found
    return [] if found is None else found


def bodiless(values: Iterable[Any]) -> str:
    """What people of OpenPose's frames have instead of a body, as a sentence; empty without people."""
    fields = {name for value in values for person in value["people"] for name, own in person.items() if own}
    return f"its people have {shown(sorted(map(str, fields)))} and no {BODY}" if fields else ""


def _points(numbers: Any, spot: str) -> Array:
    """(N, 3) x, y and score of every point, from one list of all numbers."""
    flat = person_array(numbers, (-1,), FARTHEST_PX, spot)
    if len(flat) % 3:
        raise InputError(f"{spot} has {len(flat)} numbers; it must have x, y and score of every point")
    return flat.reshape(-1, 3)


def _is_openpose_list(value: Any) -> bool:
    frames = _entries(value)
    return bool(frames) and is_openpose_frame(next((frame for frame in frames if frame is not None), None))


def _read_openpose_list(value: Any, where: str, source: str) -> DetectedFrames:
    """Read a list of frames, or an object with one as `frames`, as pose nodes of image generators save it."""
    layout: Layout | None = None
    frames, canvas = _entries(value), set()
    everyone = []
    for index, frame in enumerate(frames):
        spot = f"{where}: [{index}]"
        if frame is not None and not is_openpose_frame(frame):
            raise InputError(f"{spot} is {shown(frame)}; it must be a frame of OpenPose with people, or null")
        check_people(0 if frame is None else len(frame["people"]), f"{spot}.people")
        found = [] if frame is None else openpose_people(frame, spot)
        for _, points in found:
            layout = same_layout(layout, points, spot)
        everyone.append([person for person, _ in found])
        canvas |= {_canvas(frame, spot)} if frame is not None and found else set()
    if layout is None:
        why = bodiless(frame for frame in frames if frame is not None)
        raise InputError(f"{where}: {why or f'nobody is seen in any of its {len(frames)} frames'}")
    if len(canvas) > 1:
        raise InputError(f"{where}: canvas_width and canvas_height change; they must be those of one clip")
    longest = max(len(person.place) for people in everyone for person in people)
    if longest > layout.count:
        layout = with_hands(layout)
        everyone = [[as_long(person, longest) for person in people] for people in everyone]
    people = [tuple(people) for people in everyone]
    return by_stated_frames(
        DetectedFrames(where, source, layout, dict(enumerate(people)), False, size=canvas.pop(), shares=True),
        frames,
    )


def by_stated_frames(listed: DetectedFrames, entries: list[Any]) -> DetectedFrames:
    """The same, each entry at the frame that it says it is of, where all say that."""
    stated = stated_frames(entries)
    if stated is None:
        return listed
    people = dict(zip(stated.numbers, listed.people.values(), strict=True))
    return replace(listed, people=people, numbered=stated.numbered, complete=False, time_s=stated.time_s)


def _canvas(frame: Mapping[str, Any], spot: str) -> tuple[int, int] | None:
    size = frame.get("canvas_width"), frame.get("canvas_height")
    if size == (None, None):
        return None
    width, height = (side if type(side) is int and 0 < side <= 65536 else 0 for side in size)
    if not (width and height):
        said = f"{spot}: canvas_width and canvas_height are {shown(list(size))}"
        raise InputError(f"{said}; they must be whole pixels")
    return width, height


def as_long(person: DetectedPerson, points: int) -> DetectedPerson:
    """A person with so many points, of which those that are added are not seen."""
    added = (0, points - len(person.place))
    return DetectedPerson(np.pad(person.place, (added, (0, 0))), np.pad(person.score, added))


def _entries(value: Any) -> list[Any]:
    """The frames of a list, or of an object with one; empty where there are none."""
    frames = value.get("frames") if isinstance(value, dict) else value
    return frames if isinstance(frames, list) else []


# --- COCO's result files, as AlphaPose and others write them


def _is_coco(value: Any) -> bool:
    return (
        isinstance(value, list)
        and bool(value)
        and isinstance(value[0], dict)
        and {"image_id", "keypoints"} <= set(value[0])
    )


def _read_coco(entries: list[Any], where: str, source: str) -> DetectedFrames:
    """Read a list of `{"image_id", "keypoints": [x, y, score, ...], "score"}`.

    An image is numbered by its identifier, or by the number with which its name ends. Images in which nobody
    was seen are not listed.
    """
    layout: Layout | None = None
    people: dict[int, list[DetectedPerson]] = {}
    for index, entry in enumerate(entries):
        spot = f"{where}: [{index}]"
        if not isinstance(entry, dict):
            raise InputError(f"{spot} is {shown(entry)}; it must be an object with image_id and keypoints")
        number = _number(entry.get("image_id"), spot)
        points = _points(entry.get("keypoints"), f"{spot}.keypoints")
        layout = same_layout(layout, len(points), f"{spot}.keypoints")
        people.setdefault(number, []).append(DetectedPerson(points[:, :2], points[:, 2]))
        check_people(len(people[number]), f"{where}: image {number}")
    assert layout is not None  # there is an entry
    by_number = {number: tuple(people[number]) for number in sorted(people)}
    return DetectedFrames(where, source, layout, by_number, numbered=True, complete=False)


def _number(image: Any, spot: str) -> int:
    if isinstance(image, int) and not isinstance(image, bool) and image >= 0:
        return image
    found = re.search(r"(\d{1,15})(?:\.[A-Za-z]{1,5})?$", image[-100:]) if isinstance(image, str) else None
    if found is None:
        raise InputError(
            f"{spot}.image_id is {shown(image)}; it must be the frame's number, or an image's name that ends "
            "in it"
        )
    return int(found[1])


# --- MMPose's result files


INFO = "instance_info"


def _is_mmpose(value: Any) -> bool:
    if isinstance(value, dict):
        return isinstance(value.get(INFO), list)
    return isinstance(value, list) and bool(value) and isinstance(value[0], dict) and "instances" in value[0]


def is_instances(value: Any) -> bool:
    """Whether a JSON value is a list of people, as one frame has them; nobody is one too."""
    return isinstance(value, list) and all(
        isinstance(one, dict) and {"keypoints", "keypoint_scores"} <= set(one) for one in value
    )


def _read_mmpose(value: Any, where: str, source: str) -> DetectedFrames:
    """Read MMPose's results of a video; a file of one picture is refused."""
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
        number = entry.get("frame_id") if numbered else index
        if not isinstance(number, int) or isinstance(number, bool) or number < 0:
            raise InputError(f"{spot}.frame_id is {shown(number)}; it must be the frame's number")
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


def instance_people(instances: list[Any], where: str) -> list[DetectedPerson]:
    """The people of one frame."""
    return [_instance(instance, f"{where}[{index}]") for index, instance in enumerate(instances)]


def _instance(instance: Any, spot: str) -> DetectedPerson:
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


# --- MediaPipe's landmarks dumped as JSON


LAYOUT = LAYOUTS["blazepose33"]
# Names of the two lists, without capitals and underscores.
IMAGE, WORLD = ("landmarks", "poselandmarks"), ("worldlandmarks", "poseworldlandmarks")


def _is_mediapipe(value: Any) -> bool:
    """Whether the first frame that is not empty has landmarks."""
    frames = value.get("frames") if isinstance(value, dict) else value
    if not isinstance(frames, list):
        return False
    first = next((frame for frame in frames if frame), None)
    if isinstance(first, Mapping):
        return _field(first, IMAGE) is not None or "landmark" in first
    while isinstance(first, list) and first:
        first = first[0]
    return isinstance(first, Mapping) and {"x", "y"} <= set(first)


def _read_mediapipe(value: Any, where: str, source: str) -> DetectedFrames:
    """Read a list of frames, or an object with one as `frames`."""
    frames = value["frames"] if isinstance(value, dict) else value
    people = {index: _people(frame, f"{where}: [{index}]") for index, frame in enumerate(frames)}
    listed = DetectedFrames(where, source, LAYOUT, people, numbered=False, shares=True)
    return by_stated_frames(listed, frames)


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
    people = [one.get("landmark", one) if isinstance(one, Mapping) else one for one in value]
    if isinstance(value[0], Mapping) and "landmark" not in value[0]:
        people = [value]
    for landmarks in people:
        points = isinstance(landmarks, list) and all(isinstance(point, Mapping) for point in landmarks)
        if not points or len(landmarks) != LAYOUT.count:
            raise InputError(
                f"{spot} has {shown(landmarks)}; each person must have the {LAYOUT.count} landmarks of "
                "MediaPipe's Pose, {x, y, z, visibility} each"
            )
    return people


def _numbers(landmarks: list[Any], axes: tuple[str, ...], farthest: float, spot: str) -> Array:
    rows = [[point.get(axis) for axis in axes] for point in landmarks]
    return person_array(rows, (LAYOUT.count, len(axes)), farthest, f"{spot} ({', '.join(axes)})")


def _scores(landmarks: list[Any], spot: str) -> Array:
    """(N,) the visibilities; 1 where none is given."""
    if not any("visibility" in point for point in landmarks):
        return np.ones(LAYOUT.count)
    rows = [point.get("visibility", 0.0) for point in landmarks]
    return person_array(rows, (LAYOUT.count,), FARTHEST_PX, f"{spot} (visibility)")


FORMATS = (
    (_is_mmpose, _read_mmpose),
    (_is_coco, _read_coco),
    (_is_openpose_list, _read_openpose_list),
    (_is_mediapipe, _read_mediapipe),
)
"""How a file of all frames is known, and its reader of (value, where, source), the name of what saw them."""
