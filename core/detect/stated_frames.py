"""What the entries of a detector's list say of themselves: the frame each is of, and its time.

Programs leave out frames without a person, or look at some frames only. Where every entry carries its frame's
number or its time, that is believed instead of its position in the list.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array

NUMBERS = ("frame", "framenumber", "frameindex", "frameidx", "frameid", "framenum")
STAMPS = ("timestampms", "timems", "timestampus", "timestamp", "timestamps", "times", "timesec", "time")
"""Names of fields, without capitals and underscores, the surest first."""
MOST = 2.0**53
LONGEST_S = 1e6  # a later time is a time of day


@dataclass(frozen=True, eq=False)
class StatedFrames:
    """The frames that E entries are of."""

    numbers: tuple[int, ...]  # (E,) ascending; positions in the list where only times are stated
    numbered: bool  # whether the numbers are stated
    time_s: Array | None = None  # (E,) ascending times, where stated


def stated_frames(entries: Sequence[Any]) -> StatedFrames | None:
    """What a list's entries state; None where not all do, or where it counts something else than frames."""
    numbers, stamps = _stated(entries, NUMBERS), _stated(entries, STAMPS)
    if numbers is not None and (numbers != np.floor(numbers)).any():
        numbers = None
    time_s = None if stamps is None else stamps * _unit_s(stamps)
    if time_s is not None and not 0.0 <= time_s[0] < LONGEST_S:
        time_s = None
    if numbers is None and time_s is None:
        return None
    counted = range(len(entries)) if numbers is None else numbers
    return StatedFrames(tuple(int(number) for number in counted), numbers is not None, time_s)


def numbers_by_time(time_s: Array, fps: float | None, frame_count: int | None) -> tuple[int, ...] | None:
    """The frames at some times (E,) of a clip, counted from 0; None where they are not of this clip."""
    if fps is None or frame_count in (None, len(time_s)):
        return None  # every frame has an entry
    numbers = np.round(time_s * fps).astype(np.int64)
    if (np.diff(numbers) < 1).any() or numbers[-1] >= frame_count:
        return None
    return tuple(map(int, numbers))


def _stated(entries: Sequence[Any], names: Sequence[str]) -> Array | None:
    """(E,) the numbers in the surest field that all entries have, if they ascend."""
    if not entries or not all(isinstance(entry, Mapping) for entry in entries):
        return None
    fields = {_plain(name): name for name in entries[0] if isinstance(name, str)}
    for name in names:
        values: list[Any] = [entry.get(fields[name]) for entry in entries] if name in fields else [None]
        if all(type(value) in (int, float) and abs(value) < MOST for value in values):
            numbers = np.array(values, dtype=np.float64)
            return numbers if (np.diff(numbers) > 0.0).all() else None
    return None


def _plain(name: str) -> str:
    return name.replace("_", "").replace(" ", "").replace("-", "").lower()


def _unit_s(stamps: Array) -> float:
    """Seconds in the unit of times: between frames lie a millisecond to a second."""
    step = float(np.median(np.diff(stamps))) if len(stamps) > 1 else 0.0
    return 1.0 if step <= 1.0 else 1e-3 if step <= 1000.0 else 1e-6
