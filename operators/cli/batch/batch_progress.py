"""How far many takes are together, long ones counting for more as far as their length is known."""

from collections.abc import Sequence


class Share:
    """The share of all work that is done, kept up step by step."""

    def __init__(self, frames: Sequence[int | None]) -> None:
        """Begin with nothing done.

        Args:
            frames: The length of each take; None where it is not known, which then counts as the usual one.
        """
        self._frames = list(frames)
        self._done = [0.0] * len(self._frames)
        known = [count for count in self._frames if count is not None]
        self._known, self._known_frames = len(known), float(sum(known))
        self._done_frames = 0.0
        """Of takes whose length is known."""
        self._done_others = 0.0

    def come(self, place: int, fraction: float, frames: int | None = None) -> None:
        """A take has come so far.

        Args:
            place: Which.
            fraction: From 0 to 1.
            frames: Its length, where that has become known.
        """
        if frames is not None and self._frames[place] is None:
            self._done_others -= self._done[place]
            self._done_frames += self._done[place] * frames
            self._frames[place] = frames
            self._known, self._known_frames = self._known + 1, self._known_frames + frames
        more = fraction - self._done[place]
        self._done[place] = fraction
        length = self._frames[place]
        if length is None:
            self._done_others += more
        else:
            self._done_frames += more * length

    @property
    def value(self) -> float:
        """The share, 0 to 1."""
        if not self._frames:
            return 1.0
        usual = self._known_frames / self._known if self._known else 1.0
        whole = self._known_frames + usual * (len(self._frames) - self._known)
        return min(max((self._done_frames + usual * self._done_others) / whole, 0.0), 1.0)
