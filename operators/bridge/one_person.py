"""Keypoints that a person placed, all of them the performer's, as the people whom a source saw."""

from collections.abc import Sequence

import numpy as np

from ...core.arrays import Array
from ...core.footage.keypoints.people import People, SeenPeople


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
