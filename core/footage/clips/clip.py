"""A clip on disk, a video or an image sequence: its size and frame rate, and an iterator of its frames."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from ...arrays import Array, Image
from ...errors import InputError
from .clip_timing import is_variable_frame_rate
from .image_sequence import ImageSequence, find_images, left_out
from .video_file import VideoFile

DEFAULT_SEQUENCE_FPS = 24.0
"""Default frame rate of an image sequence, that of a new Blender scene."""


class FrameSource(Protocol):
    """Decoder of a clip's frames."""

    size: tuple[int, int]
    fps: float
    frame_count: int

    def frames(self) -> Iterator[tuple[int, float, Image]]:
        """Yield index, time in seconds and image of every frame."""
        ...

    def time_stamps(self) -> Iterator[float]:
        """Yield the time in seconds of every frame without converting its picture."""
        ...

    def at(self, indices: Sequence[int]) -> Iterator[tuple[int, Image]]:
        """Yield the frames of ascending indices, as far as they exist."""
        ...

    def onward(self, first: int) -> Iterator[tuple[float, Image]]:
        """Yield time in seconds and image of the frames from about `first` on."""
        ...


@dataclass(frozen=True)
class Clip:
    """A readable clip; opening it has decoded its first frame."""

    path: Path
    """The file, folder or pattern it was opened from."""
    source: FrameSource
    """Decoder of the frames."""
    notes: tuple[str, ...] = ()
    """Sentences on faults of the file itself."""

    @classmethod
    def open(cls, path: str | Path, fps: float | None = None) -> "Clip":
        """Open a video, a folder of images, or a numbered sequence by one of its files or a pattern.

        Patterns are `img_####.png` and `img_%04d.png`. Images follow their numbers (img_2 before img_10).

        Args:
            path: The video, folder, numbered image or pattern.
            fps: Frames per second of an image sequence; a video has its own.

        Raises:
            InputError: The path does not exist, or cannot be decoded.
        """
        path = Path(path)
        images = find_images(path)
        if images is not None:
            sequence = ImageSequence(images, fps or DEFAULT_SEQUENCE_FPS)
            return cls(path, sequence, left_out(path, images) + sequence.notes)
        if not path.exists():
            raise InputError(f"{path}: no such file; name a video, a folder of images or a numbered image")
        video = VideoFile(path)
        return cls(path, video, video.notes)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the frames in pixels, after the rotation that the file asks for."""
        return self.source.size

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

    def time_stamps(self) -> Array:
        """The time of every frame in seconds, (F,), by a pass that converts no picture."""
        return np.fromiter(self.source.time_stamps(), dtype=np.float64)

    @property
    def variable_frame_rate(self) -> bool:
        """Whether the frames are unevenly spaced in time; takes a pass over the clip."""
        return is_variable_frame_rate(self.time_stamps())

    def sample(self, count: int) -> Iterator[tuple[int, Image]]:
        """Yield about `count` frames spread evenly over the clip, each with its index.

        Raises:
            ValueError: `count` is below 1.
        """
        if count < 1:
            raise ValueError(f"count must be at least 1, not {count}")
        # Centers of equal intervals: neither the first frame nor the last, which fades and cuts spoil.
        middles = (np.arange(count) + 0.5) * self.frame_count / count
        return self.source.at(sorted({int(index) for index in middles}))
