"""A clip whose frames are checked and kept in an album while they are read, to decode it only once."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ...arrays import Image
from .album import Album
from .clip import Clip, FrameSource
from .frame_checks import FrameChecks


@dataclass(eq=False)
class _WatchedSource:
    """A source of frames that passes every frame to checks and album before yielding it."""

    size: tuple[int, int]
    fps: float
    frame_count: int
    source: FrameSource
    checks: FrameChecks
    album: Album | None

    def frames(self) -> Iterator[tuple[int, float, Image]]:
        """Yield every frame after checking it; blank ones are not kept in the album."""
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
        """Yield the frames from about `first` on."""
        return self.source.onward(first)


def watch_clip(clip: Clip, checks: FrameChecks, album: Album | None) -> Clip:
    """The clip with checks, and an album to fill, that run while its frames are read in order."""
    source = _WatchedSource(clip.size, clip.fps, clip.frame_count, clip.source, checks, album)
    return Clip(clip.path, source)
