"""A folder of JSON files, one a frame, as OpenPose, rtmlib, Pose2Sim and Sports2D write them."""

import os
import re
from pathlib import Path
from typing import Any

from ...errors import InputError
from ...files.json_file import read_json_value, shown
from ...files.safe_path import check_symlinks
from .detected_frames import (
    FARTHEST_PX,
    DetectedFrames,
    DetectedPerson,
    check_people,
    check_points,
    person_array,
    same_layout,
)
from .frame_numbers import MOST_FRAMES
from .layouts import Layout

POINTS = "pose_keypoints_2d"
LARGEST_FILE_BYTES = 4 * 2**20
"""A hundred people with hands and face."""
_NUMBER = re.compile(r"(\d{1,15})(?:_keypoints)?\.json$", re.IGNORECASE)


def is_openpose_frame(value: Any) -> bool:
    """Whether a JSON value is one frame of this format."""
    people = value.get("people") if isinstance(value, dict) else None
    return isinstance(people, list) and all(isinstance(person, dict) for person in people)


def read_openpose_folder(folder: Path) -> DetectedFrames:
    """Read the numbered files of a folder; further files are ignored.

    Raises:
        InputError: There are none, two have the same number, a link leads outside, or one cannot be used.
    """
    files = _numbered_files(folder)
    check_symlinks(files.values(), [folder])
    layout: Layout | None = None
    people: dict[int, tuple[DetectedPerson, ...]] = {}
    total = 0
    for number, path in sorted(files.items()):
        value = read_json_value(path, LARGEST_FILE_BYTES)
        if not is_openpose_frame(value):
            raise InputError(
                f'{path}: holds {shown(value)}; it must be a frame of OpenPose, {{"people": '
                f'[{{"{POINTS}": [x, y, score, ...]}}, ...]}}'
            )
        check_people(len(value["people"]), f"{path}: people")
        seen = []
        for index, entry in enumerate(value["people"]):
            where = f"{path}: people[{index}].{POINTS}"
            numbers = entry.get(POINTS)
            if numbers in (None, []):  # only a hand or a face was found
                continue
            flat = person_array(numbers, (-1,), FARTHEST_PX, where)
            if len(flat) % 3:
                raise InputError(
                    f"{where} has {len(flat)} numbers; it must have x, y and score of every point"
                )
            points = flat.reshape(-1, 3)
            layout = same_layout(layout, len(points), where)
            seen.append(DetectedPerson(points[:, :2], points[:, 2]))
            total += len(points)
            check_points(total, str(folder))  # before the next file is read
        people[number] = tuple(seen)
    if layout is None:
        raise InputError(f"{folder}: nobody is seen in any of its {len(files)} files; one must show a person")
    return DetectedFrames(str(folder), folder.name or str(folder), layout, people, numbered=True)


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
