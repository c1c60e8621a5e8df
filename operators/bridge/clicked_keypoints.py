"""Keypoints that a person placed, all of them the performer's, as the people whom a source saw."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array
from ...core.footage.keypoints.keypoints import People, SeenPeople
from .footage import Footage
from .scene_frames import shown_index


def one_person(
    names: Sequence[str], source: str, size: tuple[int, int], pixel: Array, score: Array
) -> People:
    """The people of a source that shows the performer alone.

    Args:
        names: (N,) the body points.
        source: What saw them.
        size: Width and height of the footage [px].
        pixel: (F, N, 2) places [px], NaN where a point is not seen.
        score: (F, N) confidence, 0 to 1.
    """
    unknown = np.full((1, len(names), 3), np.nan)
    nobody = SeenPeople(pixel[:0], score[:0], unknown[:0])
    there = np.isfinite(pixel).all(axis=-1).any(axis=-1)
    frames = tuple(
        SeenPeople(pixel[[index]], score[[index]], unknown) if there[index] else nobody
        for index in range(len(pixel))
    )
    return People(tuple(names), source, size, frames, by_hand=True)


# --- Points that a person clicked on in single frames, as keypoints


SOURCE = "clicks"


@dataclass(frozen=True)
class ClickedPoint:
    """A body point that was clicked on in a frame."""

    point: str
    frame: int
    """Scene frames after the clip's first one: a clip may be moved in time."""
    pixel: tuple[float, float]


def people_of_clicks(footage: Footage, frames: Array, clicks: Sequence[ClickedPoint]) -> tuple[People, ...]:
    """The performer as a person clicked on points; no source where none was.

    Args:
        footage: The clip in its scene.
        frames: (F,) scene frame of each frame of the clip.
        clicks: The points; those outside the clip are left out, the last one of a frame counts.
    """
    at = shown_index(frames, [footage.first_frame + click.frame for click in clicks])
    inside = [(int(index), click) for index, click in zip(at, clicks, strict=True) if index >= 0]
    names = list(dict.fromkeys(click.point for _, click in inside))
    if not names:
        return ()
    pixel = np.full((len(frames), len(names), 2), np.nan)
    for index, click in inside:
        pixel[index, names.index(click.point)] = click.pixel
    width, height = footage.clip.size
    score = np.isfinite(pixel).all(axis=-1).astype(np.float64)
    return (one_person(names, SOURCE, (width, height), pixel, score),)
