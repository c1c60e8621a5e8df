"""Detectors' JSON: OpenPose (rtmlib, Pose2Sim, Sports2D, pose nodes), COCO, MMPose and MediaPipe."""

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .. import MOST_FRAMES
from ..arrays import Array
from ..errors import InputError, shown
from ..files.json_file import read_json_value
from ..files.paths import check_symlinks
from .detected_frames import (
    BODY,
    FARTHEST_M,
    FARTHEST_PX,
    DetectedFrames,
    DetectedPerson,
    Everyone,
    person_array,
    placed,
)
from .layouts import HAND_POINTS, LAYOUTS

HANDS = ("hand_left_keypoints_2d", "hand_right_keypoints_2d")
OLD = "_2d"  # what names of lists did not end with before OpenPose 1.1


def is_openpose_frame(value: Any) -> bool:
    """Whether a JSON value is one frame of this format."""
    people = value.get("people") if isinstance(value, dict) else None
    return isinstance(people, list) and all(isinstance(person, dict) for person in people)


def _openpose_person(entry: Mapping[str, Any], spot: str) -> DetectedPerson | None:
    """A person with a body; where a hand was found, the points of the left hand and the right follow it."""

    def points(name: str) -> Array:
        numbers = entry.get(name)
        numbers = entry.get(name.removesuffix(OLD)) if numbers is None else numbers
        return _triples([] if numbers is None else numbers, f"{spot}.{name}")

    body = points(BODY)
    if not len(body):  # only a hand or a face was found
        return None
    hands = [own if len(own) == HAND_POINTS else None for own in map(points, HANDS)]
    if all(hand is None for hand in hands):
        return DetectedPerson(body[:, :2], body[:, 2])
    missing = np.zeros((HAND_POINTS, 3))
    every = np.concatenate([body, *(missing if hand is None else hand for hand in hands)])
    return DetectedPerson(every[:, :2], every[:, 2], body=len(body))


def _triples(numbers: Any, spot: str) -> Array:
    """(N, 3) x, y and score of every point, from one list of all numbers."""
    flat = person_array(numbers, (-1,), FARTHEST_PX, spot)
    if len(flat) % 3:
        raise InputError(f"{spot} has {len(flat)} numbers; it must have x, y and score of every point")
    return flat.reshape(-1, 3)


def _entries(value: Any) -> list[Any]:
    """The frames of a list, or of an object with one; empty where there are none."""
    frames = value.get("frames") if isinstance(value, dict) else value
    return frames if isinstance(frames, list) else []


def _is_openpose_list(value: Any) -> bool:
    return is_openpose_frame(next((frame for frame in _entries(value) if frame is not None), None))


def _read_openpose_list(value: Any, where: str, source: str) -> DetectedFrames:
    """Read a list of frames, or an object with one as `frames`, as pose nodes of image generators save it."""
    everyone, canvas = Everyone(where), set()
    frames = _entries(value)
    for index, (spot, frame) in enumerate(placed(frames, f"{where}: ").items()):
        if frame is not None and not is_openpose_frame(frame):
            raise InputError(f"{spot} is {shown(frame)}; it must be a frame of OpenPose with people, or null")
        people = [] if frame is None else frame["people"]
        everyone.add(index, placed(people, f"{spot}: people"), _openpose_person)
        if everyone.people[index]:
            canvas.add(_canvas(frame, spot))
    if len(canvas) > 1:
        raise InputError(f"{where}: canvas_width and canvas_height change; they must be those of one clip")
    return everyone.frames(source, frames, size=next(iter(canvas), None), shares=True)


def _canvas(frame: Mapping[str, Any], spot: str) -> tuple[int, int] | None:
    size = frame.get("canvas_width"), frame.get("canvas_height")
    if size == (None, None):
        return None
    width, height = (side if type(side) is int and 0 < side <= 65536 else 0 for side in size)
    if not (width and height):
        raise InputError(
            f"{spot}: canvas_width and canvas_height are {shown(list(size))}; they must be whole pixels"
        )
    return width, height


# --- COCO's result files, as AlphaPose and others write them


def _is_coco(value: Any) -> bool:
    first = value[0] if isinstance(value, list) and value else None
    return isinstance(first, dict) and {"image_id", "keypoints"} <= set(first)


def _read_coco(entries: list[Any], where: str, source: str) -> DetectedFrames:
    """Read a list of `{"image_id", "keypoints": [x, y, score, ...], "score"}`.

    An image is numbered by its identifier, or by the number with which its name ends. Images in which nobody
    was seen are not listed.
    """
    everyone = Everyone(where)
    for spot, entry in placed(entries, f"{where}: ").items():
        if not isinstance(entry, dict):
            raise InputError(f"{spot} is {shown(entry)}; it must be an object with image_id and keypoints")
        number = entry.get("image_id")
        if isinstance(number, str):
            found = re.search(r"(\d{1,15})(?:\.[A-Za-z]{1,5})?$", number[-100:])
            number = number if found is None else int(found[1])
        if type(number) is not int or number < 0:
            raise InputError(
                f"{spot}.image_id is {shown(number)}; it must be the frame's number, or an image's name that "
                "ends in it"
            )
        everyone.add(number, {f"{spot}.keypoints": entry.get("keypoints")}, _coco_person)
    everyone.people = dict(sorted(everyone.people.items()))
    return everyone.frames(source, numbered=True, complete=False)


def _coco_person(numbers: Any, spot: str) -> DetectedPerson:
    points = _triples(numbers, spot)
    return DetectedPerson(points[:, :2], points[:, 2])


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
    if not entries:
        raise InputError(f"{where}: {INFO} is empty; it must have an entry for every frame")
    everyone = Everyone(where)
    numbered = isinstance(entries[0], dict) and "frame_id" in entries[0]
    for index, (spot, entry) in enumerate(placed(entries, f"{where}: {INFO}").items()):
        instances = entry.get("instances") if isinstance(entry, dict) else None
        if not isinstance(instances, list):
            raise InputError(f"{spot} is {shown(entry)}; it must be an object with a list of instances")
        number = entry.get("frame_id") if numbered else index
        if type(number) is not int or number < 0:
            raise InputError(f"{spot}.frame_id is {shown(number)}; it must be the frame's number")
        if number in everyone.people:
            raise InputError(f"{spot}.frame_id is {number}, which stands twice; each frame must stand once")
        everyone.add(number, placed(instances, f"{spot}.instances"), _mmpose_person)
    return everyone.frames(source, numbered=numbered)


def _mmpose_person(instance: Any, spot: str) -> DetectedPerson:
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
    first = next((frame for frame in _entries(value) if frame), None)
    if isinstance(first, Mapping):
        return _field(first, IMAGE) is not None or "landmark" in first
    while isinstance(first, list) and first:
        first = first[0]
    return isinstance(first, Mapping) and {"x", "y"} <= set(first)


def _read_mediapipe(value: Any, where: str, source: str) -> DetectedFrames:
    """Read a list of frames, or an object with one as `frames`."""
    everyone, frames = Everyone(where), _entries(value)
    for index, (spot, frame) in enumerate(placed(frames, f"{where}: ").items()):
        world = None
        if isinstance(frame, Mapping) and "landmark" not in frame:
            world, frame = _field(frame, WORLD), _field(frame, IMAGE)
        people, guesses = _lists(frame, spot), _lists(world, spot)
        if guesses and len(guesses) != len(people):
            raise InputError(
                f"{spot} has {len(guesses)} world landmarks for {len(people)} people; it must have one each"
            )
        pairs = list(zip(people, guesses or (None,) * len(people), strict=True))
        everyone.add(index, placed(pairs, spot), _mediapipe_person)
    return everyone.frames(source, frames, shares=True)


def _field(frame: Mapping[str, Any], names: tuple[str, ...]) -> Any:
    """The field of one of these names, written with or without capitals and underscores."""
    return next((own for name, own in frame.items() if name.replace("_", "").lower() in names), None)


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


def _mediapipe_person(pair: tuple[list[Any], list[Any] | None], spot: str) -> DetectedPerson:
    landmarks, guess = pair
    place = _numbers(landmarks, ("x", "y"), FARTHEST_PX, spot)
    score = np.ones(len(place))  # where no visibility is given
    if any("visibility" in point for point in landmarks):
        rows = [point.get("visibility", 0.0) for point in landmarks]
        score = person_array(rows, (LAYOUT.count,), FARTHEST_PX, f"{spot} (visibility)")
    hint = None if guess is None else _numbers(guess, ("x", "y", "z"), FARTHEST_M, spot)
    return DetectedPerson(place, score, hint)


def _numbers(landmarks: list[Any], axes: tuple[str, ...], farthest: float, spot: str) -> Array:
    rows = [[point.get(axis) for axis in axes] for point in landmarks]
    return person_array(rows, (LAYOUT.count, len(axes)), farthest, f"{spot} ({', '.join(axes)})")


FORMATS = (
    (_is_mmpose, _read_mmpose),
    (_is_coco, _read_coco),
    (_is_openpose_list, _read_openpose_list),
    (_is_mediapipe, _read_mediapipe),
)
"""How a file of all frames is known, and its reader of (value, where, source), the name of what saw them."""


# --- Folders of detectors that write a file a frame


LARGEST_FILE_BYTES = 4 * 2**20  # a hundred people with hands and face
_NUMBER = re.compile(r"(\d{1,15})(?:_keypoints)?\.json$", re.IGNORECASE)


def is_one_frame(value: Any) -> bool:
    """Whether a JSON value is a single frame, whose folder has the others."""
    return is_openpose_frame(value) or (bool(value) and is_instances(value))


def read_frame_folder(folder: Path) -> DetectedFrames:
    """Read the numbered files of a folder; further files are ignored.

    Raises:
        InputError: There are none, two have the same number, a link leads outside, or one cannot be used.
    """
    files = _numbered_files(folder)
    check_symlinks(files.values(), [folder])
    everyone = Everyone(str(folder))
    for number, path in sorted(files.items()):
        value = read_json_value(path, LARGEST_FILE_BYTES)
        if is_openpose_frame(value):
            everyone.add(number, placed(value["people"], f"{path}: people"), _openpose_person)
        elif is_instances(value):
            everyone.add(number, placed(value, str(path)), _mmpose_person)
        else:
            raise InputError(
                f'{path}: holds {shown(value)}; it must be a frame of OpenPose, {{"people": [{{"{BODY}": '
                "[x, y, score, ...]}, ...]}, or of MMPose"
            )
    return everyone.frames(folder.name or str(folder), numbered=True)


def _numbered_files(folder: Path) -> dict[int, Path]:
    """The JSON files whose names end in a number, by that number."""
    files: dict[int, Path] = {}
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                found = _NUMBER.search(entry.name)
                if found is None:
                    continue
                number = int(found[1])
                if number in files:
                    one, other = sorted((files[number].name, entry.name))
                    raise InputError(
                        f"{folder}: {shown(one)} and {shown(other)} have the same number; a frame must have "
                        "one file, and each clip a folder of its own"
                    )
                if len(files) >= MOST_FRAMES:
                    raise InputError(
                        f"{folder}: has more than {MOST_FRAMES} numbered files; those of one clip are read"
                    )
                files[number] = folder / entry.name
    except OSError as error:
        raise InputError(
            f"{folder}: cannot be read ({error.strerror}); it must be a readable folder"
        ) from error
    if not files:
        raise InputError(
            f"{folder}: has no JSON file whose name ends in a number; it must be the folder that a detector "
            "has written, with files such as clip_000000000000_keypoints.json"
        )
    return files
