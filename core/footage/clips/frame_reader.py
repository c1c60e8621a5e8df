"""Frame reader for playback: a step forward decodes one frame, a jump seeks."""

from collections.abc import Iterator

from ...arrays import Image
from .clip import Clip

Stamped = tuple[float, Image]

EARLY = 0.1
"""Share of a frame's interval by which its time stamp may be rounded up."""
LONGEST_STEP = 12.0
"""Intervals up to which frames are decoded on the way instead of seeking."""
BEFORE = 2
"""Frames before the wanted one at which a seek begins."""


class FrameReader:
    """A clip's decoder that keeps its position between calls.

    Frames are found by time and not by index, so that a variable frame rate needs no pass over the clip.
    """

    def __init__(self, clip: Clip) -> None:
        """Take a clip; nothing is decoded yet."""
        self._clip = clip
        self._onward: Iterator[Stamped] = iter(())
        self._shown: Stamped | None = None
        self._coming: Stamped | None = None

    def image_at(self, time_s: float) -> Image | None:
        """The last frame that begins no later than a time, (rows, columns, 3) blue, green, red.

        None before the first frame, and once the last has been shown for an interval.

        Args:
            time_s: Seconds from the first frame.

        Raises:
            InputError: The clip is gone, or an image of a sequence cannot be read.
        """
        interval = 1.0 / self._clip.fps
        limit = time_s + EARLY * interval
        if limit < 0.0:
            return None
        if self._shown is None or not 0.0 <= limit - self._shown[0] < LONGEST_STEP * interval:
            self._begin(max(int(limit / interval) - BEFORE, 0))
            if self._shown is None or self._shown[0] > limit:
                self._begin(0)
        while self._coming is not None and self._coming[0] <= limit:
            self._shown, self._coming = self._coming, next(self._onward, None)
        if self._shown is None or (
            self._coming is None and limit >= self._shown[0] + (1.0 + EARLY) * interval
        ):
            return None
        return self._shown[1]

    def _begin(self, first: int) -> None:
        """Restart the decoder at about frame `first`."""
        self._onward = self._clip.source.onward(first)
        self._shown, self._coming = next(self._onward, None), next(self._onward, None)
