"""Progress of a batch: takes count by their length, as far as it is known."""

from collections.abc import Sequence


class BatchProgress:
    """The share of all work that is done, updated take by take."""

    def __init__(self, frames: Sequence[int | None]) -> None:
        """Begin with nothing done; a take of unknown length, None, counts as the mean of those known."""
        self._frames = list(frames)
        self._done = [0.0] * len(self._frames)
        self._known, self._known_frames, self._done_frames, self._done_others = 0, 0.0, 0.0, 0.0
        for index in range(len(self._frames)):
            self._count(index, 1)

    def update(self, index: int, fraction: float, frames: int | None = None) -> None:
        """Set how much of a take is done, 0 to 1, and its length where that has become known."""
        self._count(index, -1)
        self._done[index] = fraction
        self._frames[index] = self._frames[index] or frames
        self._count(index, 1)

    @property
    def fraction(self) -> float:
        """The share of the whole batch, from 0 to 1."""
        if not self._frames:
            return 1.0
        mean_frames = self._known_frames / self._known if self._known else 1.0
        whole = self._known_frames + mean_frames * (len(self._frames) - self._known)
        return min(max((self._done_frames + mean_frames * self._done_others) / whole, 0.0), 1.0)

    def _count(self, index: int, times: int) -> None:
        frames, done = self._frames[index], self._done[index]
        if frames is None:
            self._done_others += times * done
        else:
            self._known += times
            self._known_frames += times * frames
            self._done_frames += times * frames * done
