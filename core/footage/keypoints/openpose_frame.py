"""One frame of the JSON of OpenPose, rtmlib, Pose2Sim and Sports2D: people with flat lists of numbers."""

from typing import Any

import numpy as np

from ...arrays import Array
from ...errors import InputError
from .detected_frames import FARTHEST_PX, DetectedPerson, person_array
from .layouts import HAND_POINTS

BODY, HANDS = "pose_keypoints_2d", ("hand_left_keypoints_2d", "hand_right_keypoints_2d")


def is_openpose_frame(value: Any) -> bool:
    """Whether a JSON value is one frame of this format."""
    people = value.get("people") if isinstance(value, dict) else None
    return isinstance(people, list) and all(isinstance(person, dict) for person in people)


def openpose_people(value: Any, where: str) -> list[tuple[DetectedPerson, int]]:
    """The people of a frame, each with the number of its body's points.

    Where a hand was found, the 21 points of the left hand and those of the right follow the body's.

    Args:
        value: The frame.
        where: The file.

    Raises:
        InputError: A list is no list of x, y and score of every point.
    """
    people = []
    for index, entry in enumerate(value["people"]):
        spot = f"{where}: people[{index}]"
        body = _points(entry.get(BODY), f"{spot}.{BODY}")
        if not len(body):  # only a hand or a face was found
            continue
        hands = [_points(entry.get(name), f"{spot}.{name}") for name in HANDS]
        points = body
        if any(len(hand) == HAND_POINTS for hand in hands):
            missing = np.zeros((HAND_POINTS, 3))
            points = np.concatenate(
                [body, *(hand if len(hand) == HAND_POINTS else missing for hand in hands)]
            )
        people.append((DetectedPerson(points[:, :2], points[:, 2]), len(body)))
    return people


def _points(numbers: Any, spot: str) -> Array:
    """(N, 3) x, y and score of every point, N = 0 where there is no list."""
    if numbers in (None, []):
        return np.zeros((0, 3))
    flat = person_array(numbers, (-1,), FARTHEST_PX, spot)
    if len(flat) % 3:
        raise InputError(f"{spot} has {len(flat)} numbers; it must have x, y and score of every point")
    return flat.reshape(-1, 3)
