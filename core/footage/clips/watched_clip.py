"""A clip that is looked at while its frames are read, so that nothing has to be decoded twice."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ...arrays import Image
from .album import Album
from .clip import Clip, FrameSource
from .frame_checks import FrameChecks


@dataclass(eq=False)
class _WatchedSource:
    """A source of frames that shows every frame it yields in order to those who checks."""

    size: tuple[int, int]
    fps: float
    frame_count: int
    source: FrameSource
    checks: FrameChecks
    album: Album | None

    def frames(self) -> Iterator[tuple[int, float, Image]]:
        """Yield every frame after showing it; blank ones have no place in an album."""
        for index, time_s, image in self.source.frames():
            if self.checks.add(index, image) and self.album is not None:
                self.album.add(index, image)
            yield index, time_s, image

    def time_stamps(self) -> Iterator[float]:
        """Yield the time of every frame."""
        return self.source.time_stamps()

    def at(self, indices: Sequence[int]) -> Iterator[tuple[int, Image]]:
        """Yield the frames of ascending indices."""
        return self.source.at(indices)

    def onward(self, first: int) -> Iterator[tuple[float, Image]]:
        """Yield the frames from about one on."""
        return self.source.onward(first)


def watch_clip(clip: Clip, checks: FrameChecks, album: Album | None) -> Clip:
    """Return the clip as one that is watched, and fills an album, while its frames are read in order."""
    source = _WatchedSource(clip.size, clip.fps, clip.frame_count, clip.source, checks, album)
    return Clip(clip.path, source)
