"""What a file of keypoints holds, as its reader hands it on: in its own frame numbers, units and scores."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import InputError, shown
from ..files.kinds import number_array
from .layouts import Layout, layout_of, layout_words

MOST_PEOPLE = 100  # people of one frame; the performer among more is nobody's take
MOST_POINTS = 8 * 10**6  # points of all people in all frames of a file
FARTHEST_PX = 1e7  # of a coordinate from the origin; float32 counts single pixels up to there
FARTHEST_M = 100.0  # of a guessed point from the hips


@dataclass(frozen=True, eq=False)
class DetectedPerson:
    """One person in one frame, N points in the order of the layout; NaN where not seen."""

    place: Array  # (N, 2) coordinates, in pixels or shares of the picture
    score: Array  # (N,) the detector's own
    hint_m: Array | None = None  # (N, 3) as in `Keypoints`, where the detector guesses it


@dataclass(frozen=True, eq=False)
class DetectedFrames:
    """Everyone in a file of keypoints."""

    where: str  # the file or folder, for sentences
    source: str  # the detector, or the file
    layout: Layout
    people: Mapping[int, tuple[DetectedPerson, ...]]  # those of each frame by its number, nobody included
    numbered: bool  # whether the numbers are the file's; else they count its entries
    complete: bool = True  # whether frames in which nobody was seen have a number too
    size: tuple[int, int] | None = None
    """Width and height of the pictures the detector saw [px]; None where the file does not say."""
    shares: bool = False
    """Whether places are shares of the picture's width and height, as MediaPipe writes them."""
    fps: float | None = None  # frames per second, where the file says
    time_s: Array | None = None  # (E,) times of the entries from the clip's first frame, where the file says
    frame_start: int | None = None  # scene frame of the first entry, where the file says
    by_hand: bool = False  # as in `People`


def person_array(value: Any, shape: tuple[int, ...], farthest: float, where: str) -> Array:
    """Nested lists of numbers as an array of a shape, in which -1 is any length; null becomes NaN."""
    array = number_array(value, nulls=True)
    fits = array is not None and len(shape) == array.ndim
    if not fits or array is None or any(n not in (-1, m) for n, m in zip(shape, array.shape, strict=True)):
        words = " x ".join("any number" if length < 0 else str(length) for length in shape)
        raise InputError(f"{where} is {shown(value)}; it must be a list of numbers of shape {words}")
    if np.nanmax(np.abs(array), initial=0.0) > farthest:
        raise InputError(f"{where} has a number beyond {farthest:g}; it must be a place in a picture")
    return array


def check_people(count: int, where: str) -> None:
    """Refuse more people in a frame than are read."""
    if count > MOST_PEOPLE:
        raise InputError(f"{where} has {count} people; at most {MOST_PEOPLE} in a frame are read")


def check_points(count: int, where: str) -> None:
    """Refuse more points of all people in all frames than are read."""
    if count > MOST_POINTS:
        raise InputError(f"{where}: has {count} points in all frames; at most {MOST_POINTS} are read")


def same_layout(layout: Layout | None, count: int, where: str) -> Layout:
    """The layout of all people so far, or the first one's; another number of points is refused."""
    if layout is None:
        layout = layout_of(count)
        if layout is None:
            raise InputError(f"{where} has {count} points; layouts that are read have {layout_words()}")
    if layout.count != count:
        raise InputError(
            f"{where} has {count} points; those before have {layout.count}, and all must be alike"
        )
    return layout
