"""Keymark's own file of keypoints; see docs/keypoint_format.md."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from .. import FRAME_STARTS, MOST_FRAMES
from ..errors import InputError, shown
from ..files.fields import Fields
from ..files.json_file import read_json_value, write_json
from ..files.kinds import Anything, Choice, Items, Number, Text, Whole
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
from .keypoints import BODY_POINTS, People, SeenPeople
from .layouts import LAYOUTS, OWN, Layout, own_layout

LARGEST_SIDE_PX = 65536
LONGEST_DETECTOR = 200  # characters
NAMES = Items("body points", 1, len(BODY_POINTS), unique="point", item=Choice(BODY_POINTS))
VISIBLE = f"one line of at most {LONGEST_DETECTOR} visible characters"
Detector = Annotated[str, Text(LONGEST_DETECTOR, VISIBLE, one_line=True)]
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


def read_own(fields: Fields, name: str) -> DetectedFrames:
    """Read a file of our own, whose name stands for a detector that is not named."""
    own = read_record(OwnFile, fields)
    layout = LAYOUTS.get(own.layout)
    if layout is None:
        fields.required("names", NAMES.valid)
        layout = own_layout(NAMES.read(own.names, fields.where, "names"))
    several = own.people is not None
    if several == (own.frames is not None):
        found = "both frames and people" if several else "neither frames nor people"
        raise InputError(
            f"{fields.where}: has {found}; it must have frames, with one person in each, or people, with "
            "several"
        )
    rows = own.people or own.frames or ()
    world = own.world or (None,) * len(rows)
    if len(world) != len(rows):
        raise InputError(
            f"{fields.where}: world has {len(world)} entries; it must have one for each of the {len(rows)} "
            "frames"
        )
    field = "people" if several else "frames"
    everyone = Everyone(fields.where, layout)
    for index, (row, hints) in enumerate(zip(rows, world, strict=True)):
        where, hint_where = f"{fields.where}: {field}[{index}]", f"{fields.where}: world[{index}]"
        if row is None and hints is not None:
            raise InputError(f"{hint_where} guesses depths where nobody is seen; it must be null there")
        if not several:
            everyone.add(index, {} if row is None else {where: (row, hints, hint_where)}, _person(layout))
            continue
        if not isinstance(row, list | None):
            raise InputError(f"{where} is {shown(row)}; it must be a list of people or null")
        if hints is not None and (not isinstance(hints, list) or len(hints) != len(row or ())):
            raise InputError(
                f"{hint_where} is {shown(hints)}; it must be null or have as many people as the frame"
            )
        pairs = zip(row or (), hints or [None] * len(row or ()), strict=True)
        entries = [(one, hint, hint_where) for one, hint in pairs]
        everyone.add(index, placed(entries, where), _person(layout))
    return everyone.frames(
        own.detector or name,
        size=(own.size[0], own.size[1]),
        fps=own.fps,
        frame_start=own.frame_start,
        by_hand=bool(own.by_hand),
    )


def _person(layout: Layout) -> Callable[[tuple[Any, Any, str], str], DetectedPerson]:
    """The reader of one person: points, the guess of them in space or None, and the place of that."""

    def read(entry: tuple[Any, Any, str], where: str) -> DetectedPerson:
        value, hint, hint_where = entry
        points = person_array(value, (layout.count, 3), FARTHEST_PX, where)
        if np.isnan(points).any():
            raise InputError(
                f"{where} has null or NaN among its numbers; a point that is not seen must be [0, 0, 0]"
            )
        hint_m = None if hint is None else person_array(hint, (layout.count, 3), FARTHEST_M, hint_where)
        return DetectedPerson(points[:, :2], points[:, 2], hint_m)

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
    rows = [_written(frame, several) for frame in people.frames]
    fields["people" if several else "frames"] = [row for row, _ in rows]
    if any(hint is not None for _, hint in rows):
        fields["world"] = [hint for _, hint in rows]
    write_json(path, fields)


def _written(frame: SeenPeople, several: bool) -> tuple[Any, Any]:
    """A frame's people and their hints as JSON, None where there are none."""
    if not len(frame.pixel):
        return None, None
    seen = np.isfinite(frame.pixel).all(axis=-1) & (frame.score > 0.0)
    # A score that is rounded to 0 would say that the point is not seen.
    score = np.where(seen, np.maximum(np.round(frame.score, 4), 1e-4), 0.0)
    pixel = np.round(np.where(seen[..., None], frame.pixel, 0.0), 3)  # a thousandth of a pixel
    rows = np.concatenate([pixel, score[..., None]], axis=-1).tolist()
    hints = [
        [[float(x) if np.isfinite(x) else None for x in point] for point in np.round(hint, 4)]  # 0.1 mm
        if np.isfinite(hint).any()
        else None
        for hint in frame.hint_m
    ]
    if all(hint is None for hint in hints):
        return (rows if several else rows[0]), None
    return (rows, hints) if several else (rows[0], hints[0])


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
