"""COCO's result files, as AlphaPose and others write them: people in a list, with their images' numbers."""

import re
from typing import Any

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

_NUMBER = re.compile(r"(\d{1,15})(?:\.[A-Za-z]{1,5})?$")


def is_coco(value: Any) -> bool:
    """Whether a JSON value is of this format."""
    return (
        isinstance(value, list)
        and bool(value)
        and isinstance(value[0], dict)
        and {"image_id", "keypoints"} <= set(value[0])
    )


def read_coco(entries: list[Any], where: str, source: str) -> DetectedFrames:
    """Read a list of `{"image_id", "keypoints": [x, y, score, ...], "score"}`.

    An image is numbered by its identifier, or by the number with which its name ends. Images in which nobody
    was seen are not listed.

    Args:
        entries: The file's value.
        where: The file.
        source: Name of what saw them.

    Raises:
        InputError: An entry is something else.
    """
    layout: Layout | None = None
    people: dict[int, list[DetectedPerson]] = {}
    for index, entry in enumerate(entries):
        spot = f"{where}: [{index}]"
        if not isinstance(entry, dict):
            raise InputError(f"{spot} is {shown(entry)}; it must be an object with image_id and keypoints")
        number = _number(entry.get("image_id"), spot)
        flat = person_array(entry.get("keypoints"), (-1,), FARTHEST_PX, f"{spot}.keypoints")
        if len(flat) % 3:
            raise InputError(
                f"{spot}.keypoints has {len(flat)} numbers; it must have x, y and score of every point"
            )
        points = flat.reshape(-1, 3)
        layout = same_layout(layout, len(points), f"{spot}.keypoints")
        people.setdefault(number, []).append(DetectedPerson(points[:, :2], points[:, 2]))
        check_people(len(people[number]), f"{where}: image {number}")
    assert layout is not None  # there is an entry
    by_number = {number: tuple(people[number]) for number in sorted(people)}
    return DetectedFrames(where, source, layout, by_number, numbered=True, complete=False)


def _number(image: Any, spot: str) -> int:
    if isinstance(image, int) and not isinstance(image, bool) and image >= 0:
        return image
    found = _NUMBER.search(image[-100:]) if isinstance(image, str) else None
    if found is None:
        raise InputError(
            f"{spot}.image_id is {shown(image)}; it must be the frame's number, or an image's name that ends "
            "in it"
        )
    return int(found[1])
