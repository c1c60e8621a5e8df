"""A folder of JSON files, one a frame: OpenPose's and its kin's, and MMPose's of an image sequence."""

import os
import re
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...files.json_file import read_json_value, shown
from ...files.safe_path import check_symlinks
from .detected_frames import DetectedFrames, DetectedPerson, check_people, check_points, same_layout
from .frame_numbers import MOST_FRAMES
from .layouts import Layout, with_hands
from .mmpose_results import instance_people, is_instances
from .openpose_frame import BODY, is_openpose_frame, openpose_people

LARGEST_FILE_BYTES = 4 * 2**20
"""A hundred people with hands and face."""
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
    layout: Layout | None = None
    people: dict[int, tuple[DetectedPerson, ...]] = {}
    total = longest = 0
    for number, path in sorted(files.items()):
        found = _people(read_json_value(path, LARGEST_FILE_BYTES), str(path))
        for person, points in found:
            layout = same_layout(layout, points, str(path))
            longest = max(longest, len(person.place))
            total += len(person.place)
            check_points(total, str(folder))  # before the next file is read
        people[number] = tuple(person for person, _ in found)
    if layout is None:
        raise InputError(f"{folder}: nobody is seen in any of its {len(files)} files; one must show a person")
    if longest > layout.count:
        layout = with_hands(layout)
        people = {
            number: tuple(_as_long(person, longest) for person in there) for number, there in people.items()
        }
    return DetectedFrames(str(folder), folder.name or str(folder), layout, people, numbered=True)


def _people(value: Any, where: str) -> list[tuple[DetectedPerson, int]]:
    """The people of a file, each with the number of its body's points."""
    if is_openpose_frame(value):
        check_people(len(value["people"]), f"{where}: people")
        return openpose_people(value, where)
    if is_instances(value):
        check_people(len(value), where)
        return [(person, len(person.place)) for person in instance_people(value, where)]
    raise InputError(
        f'{where}: holds {shown(value)}; it must be a frame of OpenPose, {{"people": [{{"{BODY}": '
        "[x, y, score, ...]}, ...]}, or of MMPose"
    )


def _as_long(person: DetectedPerson, points: int) -> DetectedPerson:
    """A person with so many points, of which those that are added are not seen."""
    added = points - len(person.place)
    place = np.concatenate([person.place, np.zeros((added, 2))])
    return DetectedPerson(place, np.concatenate([person.score, np.zeros(added)]))


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
