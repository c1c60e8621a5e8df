"""Album: a small compressed picture of every frame, kept while the clip is read, to decode it only once.

The estimate needs the pictures only after it knows roughly where the performer is, and then on a coarse grid.
Compressed pictures of that grid take some kilobytes each: ten minutes fit in memory.
"""

from collections.abc import Callable, Collection, Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, BoolArray, Image, IndexArray
from .clip import Clip, spread_frames
from .frame_checks import FrameChecks
from .working_image import halvings, learning_image, measuring_image, smooth


def compressed(image: NDArray[Any]) -> Image:
    """A picture as bytes (N,); they err less than the video's compression."""
    return np.asarray(cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, 90])[1].ravel(), dtype=np.uint8)


@dataclass(eq=False)
class Pictures:
    """Small compressed pictures of some frames of a clip."""

    factor: float = 1.0  # pixels of the clip to a pixel of the pictures, along either axis
    _pictures: dict[int, Image] = field(default_factory=dict)

    def _decoded(self, index: int) -> Image:
        return np.asarray(cv2.imdecode(self._pictures[index], cv2.IMREAD_COLOR), dtype=np.uint8)

    def excluding(self, indices: Collection[int]) -> Self:
        """Those but of some frames."""
        return type(self)(self.factor, {at: own for at, own in self._pictures.items() if at not in indices})

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """The concatenated compressed pictures, with their frames and end offsets, and the factor."""
        frames = sorted(self._pictures)
        pictures = [self._pictures[frame] for frame in frames]
        return {
            "factor": np.array(self.factor),
            "frame": np.array(frames, dtype=np.int64),
            "end": np.cumsum([len(picture) for picture in pictures], dtype=np.int64),
            "picture": np.concatenate([np.zeros(0, dtype=np.uint8), *pictures]),
        }

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]]) -> Self:
        """The pictures that `to_arrays` gave."""
        pictures = np.split(arrays["picture"], arrays["end"])  # after the last end is nothing
        return cls(arrays["factor"].item(), dict(zip(arrays["frame"].tolist(), pictures, strict=False)))


@dataclass(eq=False)
class Album(Pictures):
    """Small pictures of the frames read so far, on the grid that colors are learned on."""

    _room: int = 0  # bytes of pictures that may be kept as they are
    _opened: dict[int, Image] = field(default_factory=dict)

    def add(self, index: int, image: Image) -> None:
        """Keep a frame (rows, columns, 3)."""
        small = learning_image(measuring_image(image, halvings((image.shape[1], image.shape[0]))))
        self.factor = image.shape[1] // small.shape[1]
        self._pictures[index] = compressed(small)

    def every(self, step: int) -> "Album":
        """The album of a clip that consists of every `step`-th frame, with indices of its own."""
        kept = {index // step: packed for index, packed in self._pictures.items() if index % step == 0}
        return Album(self.factor, kept)

    def warped(self, homography: Array) -> "Album":
        """The album with each picture mapped by one of the clip's homographies (F, 3, 3), edges repeated."""
        scale = np.diag([self.factor, self.factor, 1.0])
        kept = {}
        for index in self._pictures:
            image = self._decoded(index)
            own = np.linalg.inv(scale) @ homography[index] @ scale
            size = image.shape[1], image.shape[0]
            kept[index] = compressed(cv2.warpPerspective(image, own, size, borderMode=cv2.BORDER_REPLICATE))
        return Album(self.factor, kept)

    def opened(self, room: int) -> "Album":
        """The same album for many looks at the same frames: it keeps `room` bytes of what it has unpacked."""
        return Album(self.factor, self._pictures, room)

    def __contains__(self, index: int) -> bool:
        return index in self._pictures

    def pictures(self, indices: Sequence[int] | IndexArray) -> tuple[Image, BoolArray]:
        """The small pictures (F, rows, columns, 3) of F frames, and (F,) which exist; others are black."""
        known = np.array([int(index) in self for index in indices], dtype=np.bool_)
        if not self._pictures:
            raise KeyError("the album is empty")
        blank = np.zeros_like(self.picture(next(iter(self._pictures))))
        seen = [
            self.picture(int(index)) if there else blank for index, there in zip(indices, known, strict=True)
        ]
        return np.stack(seen), known

    def picture(self, index: int) -> Image:
        """A frame's small picture (rows, columns, 3), smoothed like all images that colors are read from."""
        if index in self._opened:
            return self._opened[index]
        image = smooth(self._decoded(index))
        if image.nbytes <= self._room:
            self._room -= image.nbytes
            self._opened[index] = image
        return image


Watch = Callable[[int, Image], None]
"""Sees index and picture of every frame of a clip that is read, one after the other."""

GLIMPSES, GLIMPSE_SIDE_PX = 8, 640
"""Pictures that are kept, and their longer side: the pose network sees 256 pixels of a person."""


class Glimpses(Pictures):
    """Some pictures of a clip, evenly spread, in which people are to be recognized."""

    @classmethod
    def of(cls, clip: Clip) -> "Glimpses":
        """Those of a clip that is about to be read."""
        frames = spread_frames(clip.frame_count, min(GLIMPSES, clip.frame_count))
        return cls(1.0, {frame: np.zeros(0, dtype=np.uint8) for frame in frames})

    def add(self, index: int, image: Image) -> None:
        """Keep a frame (rows, columns, 3) if it is one of them."""
        if index not in self._pictures:
            return
        scale = min(1.0, GLIMPSE_SIDE_PX / max(image.shape[:2]))
        small = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
        self.factor = image.shape[1] / small.shape[1]
        self._pictures[index] = compressed(small)

    @property
    def frames(self) -> list[int]:
        """The frames that were kept."""
        return sorted(index for index, packed in self._pictures.items() if len(packed))

    def picture(self, index: int) -> tuple[Image, float]:
        """A picture (rows, columns, 3), and how many pixels of the clip one of its is along either axis."""
        return self._decoded(index), self.factor

    def median(self) -> tuple[Image, float] | None:
        """What stands behind whatever moves, and pixels of the clip to one of it; None without pictures."""
        pictures = [self._decoded(index) for index in self.frames]
        if not pictures:  # all blank, or of other shots
            return None
        return np.asarray(np.median(np.stack(pictures), axis=0), dtype=np.uint8), self.factor


@dataclass(frozen=True, kw_only=True)
class WatchedClip(Clip):
    """A clip that passes every frame to checks, album, glimpses and `watch` before yielding it."""

    checks: FrameChecks
    album: Album | None
    glimpses: Glimpses
    watch: Watch | None = None

    def frames(self) -> Iterator[tuple[int, float, Image]]:
        """See `Clip.frames`; blank ones are not kept."""
        for index, time_s, image in self.source.frames():
            if self.checks.add(index, image):
                self.glimpses.add(index, image)
                if self.album is not None:
                    self.album.add(index, image)
            if self.watch is not None:
                self.watch(index, image)
            yield index, time_s, image


TAIL_PERCENT = 2.0  # share of the changes at either edge that are not the performer's


def picture_motion(album: Album, frames: int) -> Generator[float, None, Array]:
    """Roughly the speed (F,) [px per frame] of whatever moves in front of a camera that stands still.

    Zero where nothing changes. Missing pictures repeat the one before. Yields the fraction done.
    """
    swept = np.zeros(max(frames - 1, 0))
    rows: Array | None = None
    before: Array | None = None
    for index in range(frames):
        if index in album:
            now = cv2.cvtColor(album.picture(index), cv2.COLOR_BGR2GRAY).astype(np.float64)
            if before is not None:
                changed = changed_pixels(now - before)
                swept[index - 1] = changed.sum()
                rows = changed.sum(axis=1) + (0.0 if rows is None else rows)
            before = now
        yield (index + 1) / frames
    if rows is None or not swept.any():
        return np.zeros(frames)
    share = np.cumsum(rows) / rows.sum()
    low, high = np.searchsorted(share, [0.01 * TAIL_PERCENT, 1.0 - 0.01 * TAIL_PERCENT])
    step = 0.5 * album.factor * swept / (high - low + 1)
    padded = np.concatenate([step[:1], step, step[-1:]])
    return np.asarray(0.5 * (padded[:-1] + padded[1:]))


def changed_pixels(difference: Array) -> BoolArray:
    """Pixels that change, beside noise and the light of the whole picture."""
    difference = np.abs(difference - np.median(difference))
    usual = 1.4826 * float(np.median(difference))
    return np.asarray(difference > max(4.0 * usual, 6.0))
