"""One frame of a clip after another as a person looks at them: stepping forward costs one frame."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from .clip import Clip

Image = NDArray[np.uint8]

_LONGEST_STEP: Final = 12
"""Frames that are rather decoded on the way than searched for."""


class FrameReader:
    """A clip's decoder that stays where it is between two frames."""

    def __init__(self, clip: Clip) -> None:
        """Take a clip; nothing is decoded yet."""
        self._clip = clip
        self._onward: Iterator[tuple[int, Image]] = iter(())
        self._next = clip.frame_count
        self._shown: tuple[int, Image] | None = None

    def image(self, index: int) -> Image | None:
        """Return a frame, (rows, columns, 3) uint8 blue, green, red; None where the clip has none.

        Raises:
            InputError: the clip is gone, or an image of a sequence cannot be read.
        """
        if self._shown is not None and self._shown[0] == index:
            return self._shown[1]
        if not 0 <= index - self._next < _LONGEST_STEP:
            self._onward = self._clip.source.at(range(max(index, 0), max(self._clip.frame_count, index + 1)))
        self._shown = next((found for found in self._onward if found[0] >= index), None)
        if self._shown is None:
            self._next = self._clip.frame_count
            return None
        self._next = self._shown[0] + 1
        return self._shown[1] if self._shown[0] == index else None
