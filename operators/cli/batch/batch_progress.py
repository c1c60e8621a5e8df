"""Progress of a batch: takes count by their length, as far as it is known."""

from collections.abc import Sequence


class BatchProgress:
    """The share of all work that is done, updated job by job."""

    def __init__(self, frames: Sequence[int | None]) -> None:
        """Begin with nothing done.

        Args:
            frames: Length of each take; None where it is unknown, which counts as the mean of those known.
        """
        self._frames = list(frames)
        self._done = [0.0] * len(self._frames)
        known = [count for count in self._frames if count is not None]
        self._known, self._known_frames = len(known), float(sum(known))
        self._done_frames = 0.0
        """Of takes whose length is known."""
        self._done_others = 0.0
        """Of takes whose length is unknown, in takes."""

    def update(self, index: int, fraction: float, frames: int | None = None) -> None:
        """Set the progress of one take.

        Args:
            index: The take's, in the order of their lengths.
            fraction: From 0 to 1.
            frames: The take's length, where it has become known.
        """
        if frames is not None and self._frames[index] is None:
            self._done_others -= self._done[index]
            self._done_frames += self._done[index] * frames
            self._frames[index] = frames
            self._known, self._known_frames = self._known + 1, self._known_frames + frames
        more = fraction - self._done[index]
        self._done[index] = fraction
        length = self._frames[index]
        if length is None:
            self._done_others += more
        else:
            self._done_frames += more * length

    @property
    def fraction(self) -> float:
        """The share of the whole batch, from 0 to 1."""
        if not self._frames:
            return 1.0
        mean_frames = self._known_frames / self._known if self._known else 1.0
        whole = self._known_frames + mean_frames * (len(self._frames) - self._known)
        return min(max((self._done_frames + mean_frames * self._done_others) / whole, 0.0), 1.0)
