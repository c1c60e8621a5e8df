"""How much a clip's pictures change from frame to frame: a speed where nothing of the performer is known.

What moves sweeps over an area of about twice its height times its way in the picture: once where it goes,
once where it was. So the changed area over that height is roughly a speed.
"""

from collections.abc import Generator

import cv2
import numpy as np

from ..arrays import Array, BoolArray
from .clips.album import Album

NOISE_FACTOR = 4.0
"""A pixel changes where its difference exceeds the picture's usual one this many times ..."""
LEAST_LEVELS = 6.0
"""... and this many of 256 levels."""
MAD_TO_STD = 1.4826
TAIL_PERCENT = 2.0
"""Share of the changes at either edge that are not the performer's."""


def picture_motion(album: Album, frames: int) -> Generator[float, None, Array]:
    """Roughly the speed of whatever moves in front of a camera that stands still.

    Args:
        album: The pictures; missing ones repeat the one before.
        frames: Number of frames F of the clip.

    Yields:
        The fraction done.

    Returns:
        (F,) [px per frame], zero where nothing changes.
    """
    swept = np.zeros(max(frames - 1, 0))
    rows: Array | None = None
    before: Array | None = None
    for index in range(frames):
        if index in album:
            now = cv2.cvtColor(album.picture(index), cv2.COLOR_BGR2GRAY).astype(np.float64)
            if before is not None:
                changed = _changed(now - before)
                swept[index - 1] = changed.sum()
                rows = changed.sum(axis=1) + (0.0 if rows is None else rows)
            before = now
        yield (index + 1) / frames
    if rows is None or not swept.any():
        return np.zeros(frames)
    share = np.cumsum(rows) / rows.sum()
    low, high = np.searchsorted(share, [0.01 * TAIL_PERCENT, 1.0 - 0.01 * TAIL_PERCENT])
    step = 0.5 * album.factor * swept / (high - low + 1)
    padded = np.concatenate([step[:1], step, step[-1:]])
    return np.asarray(0.5 * (padded[:-1] + padded[1:]))


def _changed(difference: Array) -> BoolArray:
    """Pixels that change, beside noise and the light of the whole picture."""
    difference = np.abs(difference - np.median(difference))
    usual = MAD_TO_STD * float(np.median(difference))
    return np.asarray(difference > max(NOISE_FACTOR * usual, LEAST_LEVELS))
