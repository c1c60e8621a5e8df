"""Which frame of the clip each frame of a detector's result is; nothing is shifted without a word."""

import os
import re
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import InputError, pluralize, shown
from ..files.json_file import read_json_value
from ..files.paths import check_symlinks
from .detected_frames import DetectedFrames, DetectedPerson, check_people, check_points, same_layout
from .detector_formats import (
    BODY,
    as_long,
    bodiless,
    instance_people,
    is_instances,
    is_openpose_frame,
    openpose_people,
)
from .layouts import Layout, with_hands

MOST_FRAMES = 10**6


@dataclass(frozen=True)
class Alignment:
    """How a result's frames lie in the clip."""

    first: int  # number of the clip's first frame in the result
    frame_count: int  # frames of the clip
    notes: tuple[str, ...] = ()  # sentences on what was taken for granted


def tolerance(frame_count: int) -> int:
    """By how many frames a result may be longer or shorter than the clip."""
    return max(2, round(0.01 * frame_count))


def align_listed(count: int, frame_count: int | None, where: str, why: str = "") -> Alignment:
    """Align a list with one entry a frame, beginning with the clip's first; `why` may end its refusal."""
    if frame_count is None or count == frame_count:
        return Alignment(0, count)
    difference = count - frame_count
    if abs(difference) > tolerance(frame_count):
        raise InputError(
            f"{where}: has {pluralize(count, 'frame')}, the clip {frame_count}; it must have one entry for "
            f"every frame of the clip, null where nobody was seen{why or _rate_words(count, frame_count)}"
        )
    rest = "the last are not used" if difference > 0 else "in the last ones nobody is seen"
    note = f"{where}: has {pluralize(count, 'frame')}, the clip {frame_count}; the first are the same, {rest}"
    return Alignment(0, frame_count, (note,))


def align_numbered(
    numbers: Collection[int],
    frame_count: int | None,
    frame_start: int,
    where: str,
    complete: bool,
    first: int | None = None,
) -> Alignment:
    """Align frames that carry numbers, which count from 0, from 1, from the scene's first frame or otherwise.

    `complete` says whether frames in which nobody was seen have a number too, `first` which number the clip's
    first frame has by the entries' times.
    """
    lowest, highest = min(numbers), max(numbers)
    bases = sorted({0, 1, frame_start})
    if first is not None and frame_count is not None and first <= lowest and highest < first + frame_count:
        return Alignment(first, frame_count)
    if frame_count is None:
        return _without_clip(lowest, highest, bases, where)
    length = highest - lowest + 1
    if length == frame_count:
        return Alignment(lowest, frame_count, _hole_notes(numbers, lowest, frame_count, where, complete))
    fitting = [base for base in bases if base <= lowest and highest < base + frame_count]
    notes: tuple[str, ...] = ()
    if not fitting and lowest in bases and length <= frame_count + tolerance(frame_count):
        note = (
            f"{where}: goes on to frame {highest}, beyond the clip's {frame_count} frames; they are left out"
        )
        notes = (note,)
        fitting = [lowest]
    if not fitting:
        raise InputError(
            f"{where}: its frames are numbered {lowest} to {highest}; the clip has {frame_count}, so they "
            f"must lie within 0 to {frame_count - 1} or 1 to {frame_count}{_rate_words(length, frame_count)}"
        )
    touching = [base for base in fitting if base == lowest or highest == base + frame_count - 1]
    first = (touching or fitting)[0]
    missing = frame_count - len(set(numbers))
    at_end = frame_count - 1 - (highest - first)
    if complete and at_end > tolerance(frame_count):
        raise InputError(
            f"{where}: ends with frame {highest}, {pluralize(at_end, 'frame')} before the clip's last; every "
            f"frame must be there, also where nobody was seen{_rate_words(length, frame_count)}"
        )
    if len(touching or fitting) > 1 and missing:
        note = (
            f"{where}: its frames were taken to count from {first}; no frame tells for certain, so "
            "check that they lie on the performer"
        )
        notes += (note,)
    return Alignment(first, frame_count, notes + _hole_notes(numbers, first, frame_count, where, complete))


def _without_clip(lowest: int, highest: int, bases: list[int], where: str) -> Alignment:
    if lowest not in bases or highest - lowest >= MOST_FRAMES:
        raise InputError(
            f"{where}: its frames are numbered {lowest} to {highest}; they must begin with 0, 1 or the "
            f"clip's first scene frame, and be at most {MOST_FRAMES}"
        )
    return Alignment(lowest, highest - lowest + 1)


def _hole_notes(
    numbers: Collection[int], first: int, frame_count: int, where: str, complete: bool
) -> tuple[str, ...]:
    missing = frame_count - sum(0 <= number - first < frame_count for number in set(numbers))
    if not complete or not missing:
        return ()
    return (f"{where}: lacks {missing} of {pluralize(frame_count, 'frame')}; nobody is seen in them",)


def _rate_words(count: int, frame_count: int) -> str:
    """The rest of the sentence where one is a whole multiple of the other: the detector saw another rate."""
    for many, few, what in (
        (frame_count, count, "one for every {}"),
        (count, frame_count, "{} for every one"),
    ):
        times = round(many / max(few, 1))
        if 2 <= times <= 10 and abs(many - times * few) <= times:
            return f"; it has about {what.format(times)} of the clip, as if made at another frame rate"
    return ""


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
    layout: Layout | None = None
    people: dict[int, tuple[DetectedPerson, ...]] = {}
    total, longest, instead = 0, 0, ""
    for number, path in sorted(files.items()):
        value = read_json_value(path, LARGEST_FILE_BYTES)
        found = _people(value, str(path))
        if not found and not instead and is_openpose_frame(value):
            instead = bodiless([value])
        for person, points in found:
            layout = same_layout(layout, points, str(path))
            longest = max(longest, len(person.place))
            total += len(person.place)
            check_points(total, str(folder))  # before the next file is read
        people[number] = tuple(person for person, _ in found)
    if layout is None:
        nobody = f"nobody is seen in any of its {len(files)} files; one must show a person"
        raise InputError(f"{folder}: {instead or nobody}")
    if longest > layout.count:
        layout = with_hands(layout)
        people = {at: tuple(as_long(person, longest) for person in there) for at, there in people.items()}
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
