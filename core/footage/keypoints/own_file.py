"""Keymark's own file of keypoints; see docs/keypoint_format.md."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import Array
from ...errors import InputError
from ...files.control_characters import is_control_character
from ...files.fields import Fields, listed
from ...files.json_file import shown, write_json
from .body_points import BODY_POINTS
from .detected_frames import (
    FARTHEST_M,
    FARTHEST_PX,
    DetectedFrames,
    DetectedPerson,
    check_people,
    person_array,
)
from .frame_numbers import MOST_FRAMES
from .layouts import LAYOUTS, OWN, Layout, own_layout
from .people import People, SeenPeople

LARGEST_SIDE_PX = 65536
LONGEST_DETECTOR = 200
"""Characters."""
PIXEL_DIGITS, SCORE_DIGITS, HINT_DIGITS = 3, 4, 4
"""Decimals that are written: a thousandth of a pixel, a tenth of a millimeter."""


def read_own(fields: Fields, name: str) -> DetectedFrames:
    """Read a file of our own.

    Args:
        fields: The file's fields.
        name: The file's name, which stands for a detector that is not named.

    Raises:
        InputError: A field is missing or not what it must be.
    """
    layout = _layout(fields)
    several = fields.has("people")
    if several == fields.has("frames"):
        found = "both frames and people" if several else "neither frames nor people"
        raise InputError(
            f"{fields.where}: has {found}; it must have frames, with one person in each, or people, with "
            "several"
        )
    rows = _rows(fields, "people" if several else "frames")
    world = _rows(fields, "world") if fields.has("world") else [None] * len(rows)
    if len(world) != len(rows):
        raise InputError(
            f"{fields.where}: world has {len(world)} entries; it must have one for each of the {len(rows)} "
            "frames"
        )
    field = "people" if several else "frames"
    people = {}
    for index, (row, hints) in enumerate(zip(rows, world, strict=True)):
        where = f"{fields.where}: {field}[{index}]"
        hint_where = f"{fields.where}: world[{index}]"
        if not several:
            row, hints = _alone(row), _alone(hints)
        people[index] = _frame(row, hints, layout, where, hint_where)
    return DetectedFrames(
        where=fields.where,
        source=_detector(fields, name),
        layout=layout,
        people=people,
        numbered=False,
        size=_size(fields),
        fps=fields.number("fps", 1.0, 1000.0, "frames per second") if fields.has("fps") else None,
        frame_start=fields.integer("frame_start", -(10**6), 10**6) if fields.has("frame_start") else None,
        by_hand=_by_hand(fields),
    )


def write_keypoints(path: Path, people: People, frame_start: int, fps: float | None = None) -> None:
    """Write a file of our own, atomically; `read_keypoints` reads it back.

    Args:
        path: The file; an older one is replaced.
        people: Whom a source saw, in every frame of the clip.
        frame_start: Scene frame of the clip's first frame.
        fps: Frames per second of the clip.

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


def _by_hand(fields: Fields) -> bool:
    value = fields.values.get("by_hand")
    if value is not None and not isinstance(value, bool):
        raise InputError(f"{fields.where}: by_hand is {shown(value)}; it must be true or false")
    return bool(value)


def _alone(entry: Any) -> Any:
    return None if entry is None else [entry]


def _layout(fields: Fields) -> Layout:
    valid = f"one of {listed((*LAYOUTS, OWN))}"
    name = fields.text("layout", valid)
    if name != OWN and name not in LAYOUTS:
        raise InputError(f"{fields.where}: layout is {shown(name)}; it must be {valid}")
    if name != OWN:
        return LAYOUTS[name]
    names = fields.required("names", "a list of body points")
    known = isinstance(names, list) and all(isinstance(one, str) and one in BODY_POINTS for one in names)
    if not known or not names or len(set(names)) != len(names):
        raise InputError(
            f"{fields.where}: names is {shown(names)}; it must be a list of body points, each once: "
            f"{listed(BODY_POINTS)}"
        )
    return own_layout(names)


def _rows(fields: Fields, name: str) -> list[Any]:
    rows = fields.required(name, "a list with one entry a frame")
    if not isinstance(rows, list) or not 1 <= len(rows) <= MOST_FRAMES:
        raise InputError(
            f"{fields.where}: {name} is {shown(rows)}; it must be a list with one entry a frame, at most "
            f"{MOST_FRAMES}"
        )
    return rows


def _detector(fields: Fields, name: str) -> str:
    if not fields.has("detector"):
        return name
    valid = f"one line of at most {LONGEST_DETECTOR} visible characters"
    text = fields.text("detector", valid)
    if len(text) > LONGEST_DETECTOR or any(map(is_control_character, text)):
        raise InputError(f"{fields.where}: detector is {shown(text)}; it must be {valid}")
    return text


def _size(fields: Fields) -> tuple[int, int]:
    valid = f"[width, height] of the clip in whole pixels, at most {LARGEST_SIDE_PX}"
    width, height = fields.numbers("size", 2, 1.0, LARGEST_SIDE_PX, valid)
    if width != int(width) or height != int(height):
        raise InputError(f"{fields.where}: size is {[width, height]}; it must be {valid}")
    return int(width), int(height)


def _frame(row: Any, hints: Any, layout: Layout, where: str, hint_where: str) -> tuple[DetectedPerson, ...]:
    if row is None:
        if hints is not None:
            raise InputError(f"{hint_where} guesses depths where nobody is seen; it must be null there")
        return ()
    if not isinstance(row, list):
        raise InputError(f"{where} is {shown(row)}; it must be a list of people or null")
    check_people(len(row), where)
    if hints is not None and (not isinstance(hints, list) or len(hints) != len(row)):
        raise InputError(
            f"{hint_where} is {shown(hints)}; it must be null or have as many people as the frame"
        )
    return tuple(
        _person(one, hints[index] if hints is not None else None, layout, where, hint_where)
        for index, one in enumerate(row)
    )


def _person(value: Any, hint: Any, layout: Layout, where: str, hint_where: str) -> DetectedPerson:
    points = person_array(value, (layout.count, 3), FARTHEST_PX, where)
    if np.isnan(points).any():
        raise InputError(
            f"{where} has null or NaN among its numbers; a point that is not seen must be [0, 0, 0]"
        )
    hint_m = None if hint is None else person_array(hint, (layout.count, 3), FARTHEST_M, hint_where)
    return DetectedPerson(points[:, :2], points[:, 2], hint_m)


def _written(frame: SeenPeople, several: bool) -> tuple[Any, Any]:
    """A frame's people and their hints as JSON, None where there are none."""
    if not len(frame.pixel):
        return None, None
    seen = np.isfinite(frame.pixel).all(axis=-1) & (frame.score > 0.0)
    # A score that is rounded to 0 would say that the point is not seen.
    score = np.where(seen, np.maximum(np.round(frame.score, SCORE_DIGITS), 10.0**-SCORE_DIGITS), 0.0)
    pixel = np.round(np.where(seen[..., None], frame.pixel, 0.0), PIXEL_DIGITS)
    rows = np.concatenate([pixel, score[..., None]], axis=-1).tolist()
    hints = [_written_hints(hint) for hint in frame.hint_m]
    if all(hint is None for hint in hints):
        return (rows if several else rows[0]), None
    return (rows, hints) if several else (rows[0], hints[0])


def _written_hints(hint: Array) -> Sequence[Any] | None:
    if not np.isfinite(hint).any():
        return None
    rounded = np.round(hint, HINT_DIGITS)
    return [[float(x) if np.isfinite(x) else None for x in row] for row in rounded]
