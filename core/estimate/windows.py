"""Cutting a long clip into overlapping windows, so that memory does not grow with it."""

from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class Window:
    """A range of frames that is solved, and the part of it whose result is kept."""

    first: int
    last: int
    """One past the last frame solved."""
    keep_first: int
    keep_last: int
    """One past the last frame kept."""

    @property
    def frames(self) -> slice:
        """The frames solved."""
        return slice(self.first, self.last)

    @property
    def kept(self) -> slice:
        """The frames kept, counted from the window's first."""
        return slice(self.keep_first - self.first, self.keep_last - self.first)


def windows(frames: int, length: int, margin: int) -> Iterator[Window]:
    """Windows whose kept parts follow each other without a gap.

    Args:
        frames: Frames of the clip.
        length: Frames kept of a window; a clip up to 1.5 times as long stays whole.
        margin: Frames solved beyond the kept ones on either side, where the clip has them.
    """
    count = max(1, round(frames / length))
    edges = [frames * i // count for i in range(count + 1)]
    for start, stop in zip(edges[:-1], edges[1:], strict=True):
        yield Window(max(start - margin, 0), min(stop + margin, frames), start, stop)
