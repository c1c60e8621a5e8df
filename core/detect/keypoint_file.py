"""Keymark's own file of keypoints; see docs/keypoint_format.md."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from .. import FRAME_STARTS, MOST_FRAMES
from ..arrays import Array
from ..body.skeleton import SIDES
from ..errors import InputError, shown
from ..files.fields import Fields
from ..files.json_file import read_json_value, write_json
from ..files.kinds import Anything, Choice, Items, Number, Whole
from ..files.paths import is_control_character
from ..files.records import Record, read_record
from .clip_fit import held_against_clip
from .detected_frames import (
    FARTHEST_M,
    FARTHEST_PX,
    DetectedFrames,
    DetectedPerson,
    Everyone,
    person_array,
    placed,
)
from .detector_formats import FORMATS, is_instances, is_openpose_frame, read_frame_folder
from .keypoints import (
    FACE_NUMBERS,
    HAND_NUMBERS,
    LONGEST_DETECTOR,
    NAMES,
    Detector,
    People,
    SecondSource,
    SeenPeople,
)
from .layouts import LAYOUTS, OWN, Layout, own_layout

LARGEST_SIDE_PX = 65536
Rows = Annotated[tuple[Any, ...], Items("entries, one a frame", 1, MOST_FRAMES, item=Anything("an entry"))]


@dataclass(frozen=True)
class OwnFile(Record):
    """The fields of a file of our own."""

    TITLE = "keypoints"

    layout: Annotated[str, Choice((*LAYOUTS, OWN))]
    """Order of the points of a person; own is that of names."""
    size: Annotated[
        tuple[Annotated[int, Whole(1, LARGEST_SIDE_PX)], ...],
        Items("numbers", 2, 2, f"[width, height] of the clip in whole pixels, at most {LARGEST_SIDE_PX}"),
    ]
    """Width and height of the pictures in which they were seen [px]; of the clip, or of the same
    proportions."""
    names: Annotated[Any, Anything("a list of body points")] = None
    """Body points of the layout own, each once; other layouts ignore it."""
    detector: Detector | None = None
    """What saw the points; shown to people."""
    frame_start: Annotated[int, Whole(*FRAME_STARTS)] | None = None
    """Scene frame of the first entry, which is the clip's first frame."""
    fps: Annotated[float, Number(1.0, 1000.0, "frames per second")] | None = None
    """Frames per second of the clip."""
    by_hand: bool | None = None
    """Whether a person placed the points; they are then the performer's."""
    frames: Rows | None = None
    """One person a frame, null where nobody is seen; instead of people."""
    people: Rows | None = None
    """A list of people a frame, null where nobody is seen; instead of frames."""
    world: Rows | None = None
    """A network's guess of the same points in space, in the order of frames or people; null where there is
    none."""
    face: Rows | None = None
    """Faces in the order of frames or people: middle [px], turn from facing the viewer [rad], and how sure it
    is; null where none was looked for."""
    hands: Rows | None = None
    """Left and right hand in the order of frames or people: wrist [px], and of two looks turn from rest
    [rad], how sure there is a hand, and its side; null where none was looked for."""
    second: SecondSource | None = None
    """A network of somebody's own that looked at the same people; with the layout own."""


def read_own(fields: Fields, name_of_source: str) -> DetectedFrames:
    """Read a file of our own, whose own name stands for a detector that is not named."""
    own = read_record(OwnFile, fields)
    layout = LAYOUTS.get(own.layout)
    if layout is None:
        fields.required("names", NAMES.valid)
        names = NAMES.read(own.names, fields.where, "names")
        layout = own_layout((*names, *(() if own.second is None else own.second.names)))
    elif own.second is not None:
        raise InputError(f"{fields.where}: has second with the layout {own.layout}; it must be {OWN}")
    several = own.people is not None
    if several == (own.frames is not None):
        found = "both frames and people" if several else "neither frames nor people"
        raise InputError(
            f"{fields.where}: has {found}; it must have frames, with one person in each, or people, with "
            "several"
        )
    rows = own.people or own.frames or ()
    more = {name: value for name in MORE if (value := getattr(own, name)) is not None}
    for name, entries in more.items():
        if len(entries) != len(rows):
            raise InputError(
                f"{fields.where}: {name} has {len(entries)} entries; it must have one for each of the "
                f"{len(rows)} frames"
            )
    field = "people" if several else "frames"
    everyone = Everyone(fields.where, layout)
    for index, row in enumerate(rows):
        where = f"{fields.where}: {field}[{index}]"
        seen = {name: (entries[index], f"{fields.where}: {name}[{index}]") for name, entries in more.items()}
        for value, spot in seen.values():
            if row is None and value is not None:
                raise InputError(f"{spot} has something where nobody is seen; it must be null there")
        if not several:
            everyone.add(index, {} if row is None else {where: (row, seen)}, _person(layout))
            continue
        if not isinstance(row, list | None):
            raise InputError(f"{where} is {shown(row)}; it must be a list of people or null")
        for value, spot in seen.values():
            if value is not None and (not isinstance(value, list) or len(value) != len(row or ())):
                raise InputError(
                    f"{spot} is {shown(value)}; it must be null or have as many people as the frame"
                )
        everyone.add(
            index,
            placed(
                [
                    (one, {name: (value and value[at], spot) for name, (value, spot) in seen.items()})
                    for at, one in enumerate(row or ())
                ],
                where,
            ),
            _person(layout),
        )
    return everyone.frames(
        own.detector or name_of_source,
        size=(own.size[0], own.size[1]),
        fps=own.fps,
        frame_start=own.frame_start,
        by_hand=bool(own.by_hand),
        second=own.second,
    )


MORE = {"world": "hint_m", "face": "face", "hands": "hands"}
"""Fields with more about the people of frames or people, and what it is of a person."""


def _person(layout: Layout) -> Callable[[tuple[Any, dict[str, tuple[Any, str]]], str], DetectedPerson]:
    """The reader of one person: points, and what there is more of it by field, with its place."""

    def read(entry: tuple[Any, dict[str, tuple[Any, str]]], where: str) -> DetectedPerson:
        value, more = entry
        points = person_array(value, (layout.count, 3), FARTHEST_PX, where)
        if np.isnan(points).any():
            raise InputError(
                f"{where} has null or NaN among its numbers; a point that is not seen must be [0, 0, 0]"
            )
        shapes = {
            "world": ((layout.count, 3), FARTHEST_M),
            "face": ((FACE_NUMBERS,), FARTHEST_PX),
            "hands": ((len(SIDES), HAND_NUMBERS), FARTHEST_PX),
        }
        known: dict[str, Any] = {
            MORE[name]: person_array(own, *shapes[name], spot)
            for name, (own, spot) in more.items()
            if own is not None
        }
        return DetectedPerson(points[:, :2], points[:, 2], **known)

    return read


def write_keypoints(path: Path, people: People, frame_start: int, fps: float | None = None) -> None:
    """Write a file of our own, atomically; `read_keypoints` reads it back.

    Raises:
        ConversionError: The file cannot be written.
    """
    several = people.most_people > 1
    fields: dict[str, Any] = {"detector": people.source[:LONGEST_DETECTOR] or "unknown", "layout": OWN}
    fields |= {"names": list(people.names), "size": list(people.size), "frame_start": frame_start}
    if fps is not None:
        fields["fps"] = fps
    if people.by_hand:
        fields["by_hand"] = True
    if people.second is not None:
        fields["names"] = list(people.names[: -len(people.second.names)])
        fields["second"] = people.second.to_json()
    rows = [list(_written(frame)) for frame in people.frames]
    for name, column in zip(("people" if several else "frames", *MORE), zip(*rows, strict=True), strict=True):
        if name in MORE and not any(own for row in column for own in row):
            continue
        fields[name] = [(list(row) if several else row[0]) if any(row) else None for row in column]
    write_json(path, fields)


def _written(frame: SeenPeople) -> Iterator[list[Any]]:
    """A frame's people as JSON: their points, and what there is more of them by field, None where none."""
    seen = np.isfinite(frame.pixel).all(axis=-1) & (frame.score > 0.0)
    # A score that is rounded to 0 would say that the point is not seen.
    score = np.where(seen, np.maximum(np.round(frame.score, 4), 1e-4), 0.0)
    pixel = np.round(np.where(seen[..., None], frame.pixel, 0.0), 3)  # a thousandth of a pixel
    yield np.concatenate([pixel, score[..., None]], axis=-1).tolist()
    # Tenths of a millimeter.
    yield [_numbers(np.round(hint, 4)) if np.isfinite(hint).any() else None for hint in frame.hint_m]
    yield [np.round(face, 4).tolist() if np.isfinite(face).all() else None for face in frame.face]
    yield [_numbers(np.round(own, 4)) if np.isfinite(own).any() else None for own in frame.hands]


def _numbers(rows: Array) -> list[list[float | None]]:
    """Rows of numbers as JSON, null where there is none."""
    return [[float(x) if np.isfinite(x) else None for x in row] for row in rows]


LARGEST_BYTES = 128 * 2**20  # twenty minutes of two people with their hints of depth


def read_keypoints(
    path: Path,
    frame_count: int | None,
    size: tuple[int, int],
    fps: float | None = None,
    frame_start: int = 1,
    stored_size: tuple[int, int] | None = None,
) -> People:
    """Read keypoints of a clip, whatever wrote them; `notes` says what was taken for granted.

    Args:
        path: A file, or the folder of a detector that writes one file a frame.
        frame_count: Frames of the clip; None where it is not known, then as many as the file has.
        size: Width and height of the clip's pictures [px].
        fps: Frames per second of the clip; None where it is not known.
        frame_start: Scene frame of the clip's first frame.
        stored_size: Size of the pictures in the file, whose pixels need not be square.

    Raises:
        InputError: It is no such file, is damaged, is of another clip, or shows nobody.
    """
    return held_against_clip(_read(path), frame_count, size, fps, frame_start, stored_size)


def _read(path: Path) -> DetectedFrames:
    source = "".join("?" if is_control_character(char) else char for char in path.name)[:200]
    if path.is_dir():
        return read_frame_folder(path)
    value = read_json_value(path, LARGEST_BYTES)
    where = str(path)
    if isinstance(value, dict) and "layout" in value:
        return read_own(Fields(value, where), source)
    for recognizes, read in FORMATS:
        if recognizes(value):
            return read(value, where, source)
    raise InputError(
        f"{path}: {_seen(value)}; it must be Keymark's own file (with layout and frames), a folder of "
        "OpenPose's files, or a result file of MMPose, COCO or MediaPipe"
    )


def _seen(value: Any) -> str:
    """What a file of no known format holds."""
    if value in ([], {}):
        return "is empty"
    if is_openpose_frame(value):
        return "holds one frame of OpenPose, whose folder must be given"
    if is_instances(value):
        return "holds one picture of MMPose, whose folder must be given"
    if isinstance(value, dict):
        return f"holds an object with the fields {shown(list(value)[:8])}, which no known format has"
    return f"holds {shown(value)}"
