"""Windows of a long clip, so that memory does not grow with it."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import IndexArray
from ..body.posture import Posture


@dataclass(frozen=True)
class Window:
    """A range of frames that is solved, and the part of it whose result is kept."""

    first: int
    last: int  # one past the last frame solved
    keep_first: int
    keep_last: int  # one past the last frame kept

    @property
    def frames(self) -> slice:
        """The frames solved."""
        return slice(self.first, self.last)

    @property
    def kept(self) -> slice:
        """The frames kept, counted from the window's first."""
        return slice(self.keep_first - self.first, self.keep_last - self.first)

    def moved(self, first: int) -> "Window":
        """The window of a stretch that begins at a frame of the clip, as a window of the clip."""
        return Window(self.first + first, self.last + first, self.keep_first + first, self.keep_last + first)


def windows(frames: int, length: int, margin: int) -> Iterator[Window]:
    """Windows whose kept parts follow each other without a gap.

    A clip up to 1.5 times `length` stays whole; `margin` frames on either side are solved but not kept.
    """
    count = max(1, round(frames / length))
    edges = [frames * i // count for i in range(count + 1)]
    for start, stop in zip(edges[:-1], edges[1:], strict=True):
        yield Window(max(start - margin, 0), min(stop + margin, frames), start, stop)


def evenly_spread(frame: IndexArray) -> IndexArray:
    """Indices of at most 60 of the keyframes at increasing frames, evenly spread in time."""
    most = 60  # enough for a few parameters
    if len(frame) <= most:
        return np.arange(len(frame))
    wanted = np.linspace(frame[0], frame[-1], most)
    return np.unique(np.abs(frame[:, None] - wanted).argmin(axis=0))


def spliced(base: Posture, spans: list[Window], pieces: list[Posture]) -> Posture:
    """The base postures (F,) with those that windows keep in their place."""
    translation, rotations, angles = base.translation.copy(), base.rotations.copy(), base.angles.copy()
    for window, piece in zip(spans, pieces, strict=True):
        inner = slice(window.keep_first, window.keep_last)
        translation[inner], rotations[inner], angles[inner] = piece.translation, piece.rotations, piece.angles
    return Posture(base.skeleton, translation, rotations, angles)
