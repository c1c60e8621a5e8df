"""A clip on disk, a video or an image sequence: its size and frame rate, and an iterator of its frames."""

from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from ..arrays import Image
from ..errors import InputError, shown
from ..files.paths import VIDEOS
from .container import quickly_found
from .image_sequence import ImageSequence, find_images, left_out
from .video_file import VideoFile
from .working_image import halvings, measuring_image


class FrameSource(Protocol):
    """Decoder of a clip's frames."""

    size: tuple[int, int]
    fps: float
    frame_count: int

    def frames(self) -> Iterator[tuple[int, float, Image]]:
        """Yield index, time in seconds and image of every frame."""

    def time_stamps(self) -> Iterator[float]:
        """Yield the time in seconds of every frame without converting its picture."""

    def at(self, indices: Sequence[int]) -> Iterator[tuple[int, Image]]:
        """Yield the frames of ascending indices, as far as they exist."""

    def onward(self, first: int) -> Iterator[tuple[float, Image]]:
        """Yield time in seconds and image of the frames from about `first` on."""


@dataclass(frozen=True)
class Clip:
    """A readable clip; opening it has decoded its first frame."""

    path: Path  # the file, folder or pattern it was opened from
    source: FrameSource  # decoder of the frames
    notes: tuple[str, ...] = ()  # sentences on faults of the file itself

    @classmethod
    def open(cls, path: str | Path, fps: float | None = None, size: tuple[int, int] | None = None) -> "Clip":
        """Open a video, a folder of images, or a numbered sequence by one of its files or a pattern.

        Patterns are `img_####.png` and `img_%04d.png`. Images follow their numbers (img_2 before img_10);
        `fps` is theirs, a video has its own. Pixels that are not square are scaled to such, unless `size`
        says that the clip is known with the pixels that it stores, as in Blender.

        Raises:
            InputError: The path does not exist, or cannot be decoded.
        """
        path = Path(path)
        images = find_images(path)
        if images is not None:
            sequence = ImageSequence(images, fps or 24.0)  # that of a new Blender scene
            return cls(path, sequence, left_out(path, images) + sequence.notes)
        if not path.exists():
            folder = path.parent.iterdir() if path.parent.is_dir() else ()
            beside = [file.name for file in folder if file.suffix.lower() in VIDEOS]
            only = f"; the only video beside it is {shown(beside[0])}" if len(beside) == 1 else ""
            raise InputError(
                f"{path}: no such file; name a video, a folder of images or a numbered image{only}"
            )
        video = VideoFile(path, size)
        return cls(path, video, video.notes)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the frames in square pixels, after the rotation that the file asks for."""
        return self.source.size

    @property
    def stored_size(self) -> tuple[int, int]:
        """The same in the pixels that the file stores, which need not be square."""
        return self.source.stored_size if isinstance(self.source, VideoFile) else self.size

    @property
    def fps(self) -> float:
        """Nominal frames per second."""
        return self.source.fps

    @property
    def knows_its_rate(self) -> bool:
        """Whether the frame rate is the footage's own: images have none."""
        return not isinstance(self.source, ImageSequence)

    @property
    def frame_count(self) -> int:
        """Number of frames according to the file's header; a pass over them gives the true count."""
        return self.source.frame_count

    def frames(self) -> Iterator[tuple[int, float, Image]]:
        """Yield (index, time in seconds, image) of every frame in order, in one pass and constant memory.

        Images are (height, width, 3) uint8 in the order blue, green, red. Time counts from the first frame
        and is the file's own stamp, so it is right for variable frame rates too.

        Raises:
            InputError: An image of a sequence cannot be read or has another size than the first.
        """
        return self.source.frames()

    def sample(self, count: int) -> Iterator[tuple[int, Image]]:
        """Yield about `count` frames spread evenly over the clip, each with its index."""
        return self.source.at(spread_frames(self.frame_count, count))


def spread_frames(frame_count: int, count: int) -> list[int]:
    """Middles of `count` equal intervals: neither first nor last frame, which fades and cuts spoil."""
    return sorted({int(index) for index in (np.arange(count) + 0.5) * frame_count / count})


Stamped = tuple[float, Image]

EARLY = 0.1  # share of a frame's interval by which its time stamp may be rounded up


class FrameReader:
    """A clip's decoder that keeps its position between calls.

    Frames are found by time and not by index, so that a variable frame rate needs no pass over the clip.
    """

    def __init__(self, clip: Clip) -> None:
        self._clip = clip
        self._onward: Iterator[Stamped] = iter(())
        self._shown: Stamped | None = None
        self._coming: Stamped | None = None

    def image_at(self, time_s: float) -> Image | None:
        """The last frame (rows, columns, 3) that begins no later than a time from the first frame.

        None before the first frame, and once the last has been shown for an interval.
        """
        interval = 1.0 / self._clip.fps
        limit = time_s + EARLY * interval
        if limit < 0.0:
            return None
        # More are not decoded on the way.
        if self._shown is None or not 0.0 <= limit - self._shown[0] < 12.0 * interval:
            self._begin(max(int(limit / interval) - 2, 0))
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
        self._onward = self._clip.source.onward(first)
        self._shown, self._coming = next(self._onward, None), next(self._onward, None)


SAMPLED_FRAMES = 24
"""Twice as many as colors are learned from, so that most frames are checked with colors learned elsewhere."""


@dataclass(frozen=True, eq=False)
class ClipSamples:
    """N sampled frames of a clip."""

    path: Path  # the clip, for messages
    size: tuple[int, int]  # width and height of its frames in px
    indices: tuple[int, ...]  # (N,) their frame indices
    images: tuple[Image, ...]
    """Their pictures, (rows, columns, 3) uint8 blue, green, red on the measuring grid."""


def sample_clip(clip: Clip, count: int = SAMPLED_FRAMES) -> Generator[float, None, ClipSamples]:
    """Sample up to `count` frames evenly over a clip; yields the fraction done.

    Raises:
        InputError: None of them can be read.
    """
    return _kept(clip, clip.sample(count), min(count, clip.frame_count))


MOST_DECODED_PX = 90_000_000  # budget of decoded pixels: about half a second of a processor, at any size
FRAMES_PER_SEARCH = 18  # frames decoded for each seek


def sample_spread_frames(clip: Clip, count: int = SAMPLED_FRAMES) -> Generator[float, None, ClipSamples]:
    """Sample frames like `sample_clip`, within a budget of decoded pixels."""
    pixels = clip.size[0] * clip.size[1]
    if not isinstance(clip.source, VideoFile):
        affordable = max(MOST_DECODED_PX // (4 * pixels), 3)  # an image costs as much as four video frames
        return (yield from sample_clip(clip, min(count, affordable)))
    if clip.frame_count * pixels <= MOST_DECODED_PX:
        return (yield from sample_clip(clip, count))
    most = min(count, 12, max(MOST_DECODED_PX // (FRAMES_PER_SEARCH * pixels), 3))
    indices = quickly_found(clip.path, spread_frames(clip.frame_count, most))
    if indices:
        return (yield from _kept(clip, clip.source.sought([0, *indices]), len(indices) + 1))
    # In files that cannot be seeked, only the beginning is affordable.
    first = range(0, min(clip.frame_count, MOST_DECODED_PX // pixels + 1), FRAMES_PER_SEARCH)
    return (yield from _kept(clip, clip.source.at(first), len(first)))


def _kept(clip: Clip, frames: Iterator[tuple[int, Image]], count: int) -> Generator[float, None, ClipSamples]:
    times = halvings(clip.size)
    found = []
    yield 0.0
    for index, image in frames:
        found.append((index, measuring_image(image, times)))
        yield min(len(found) / count, 1.0)
    if not found:
        raise InputError(f"{clip.path}: none of the sampled frames can be read; the file is damaged")
    return ClipSamples(clip.path, clip.size, tuple(i for i, _ in found), tuple(image for _, image in found))
