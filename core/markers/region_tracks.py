"""Markers as they are worn, their image regions as detected, expected and tracked, and the frames' times."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, BoolArray, Image, IntArray, freeze


@dataclass(frozen=True)
class MarkerStyle:
    """A colored surface marker as the performer wears it."""

    name: str  # the marker's name
    segment: str  # the body segment it is bound to
    color_srgb: tuple[int, int, int]  # one eyedropper sample of the footage, (red, green, blue) in 0..255


@dataclass(frozen=True, eq=False)
class RegionTracks:
    """The markers' image regions over a clip of F frames and M markers; NaN where a marker is hidden."""

    names: tuple[str, ...]  # the markers, in the order of the second axis
    centroid: Array  # (F, M, 2) px, origin at the outer corner of the top left pixel
    second_moment: Array  # (F, M, 2, 2) px², the second central moment matrix A of eq. 2
    area: Array  # (F, M) px
    quality: Array
    """(F, M) in 0..1; confidence that the region is the whole marker and nothing else, 0 where hidden."""
    clipped: BoolArray  # (F, M) whether the region touches the image's border
    time_s: Array  # (F,) time stamps of the frames in seconds, from the first frame
    size: tuple[int, int]  # width and height of the image in px
    notes: tuple[str, ...] = ()  # sentences on possible faults of the tracks

    def __post_init__(self) -> None:
        frames, markers = len(self.time_s), len(self.names)
        tails = {"centroid": (2,), "second_moment": (2, 2), "area": (), "quality": (), "clipped": ()}
        shapes = {name: (frames, markers, *tail) for name, tail in tails.items()} | {"time_s": (frames,)}
        freeze(self, shapes, flags=("clipped",))

    @classmethod
    def unmarked(cls, time_s: Array, size: tuple[int, int]) -> "RegionTracks":
        """Tracks of a performer who wears no marker, M = 0, at the times (F,) [s]."""
        frames, none = len(time_s), np.zeros((len(time_s), 0))
        pairs, matrices = np.zeros((frames, 0, 2)), np.zeros((frames, 0, 2, 2))
        return cls((), pairs, matrices, none, none, none.astype(np.bool_), time_s, size)

    def frames(self, own: slice) -> "RegionTracks":
        """The tracks of some frames, their times included."""
        arrays: dict[str, Any] = {
            name: value for name, value in vars(self).items() if isinstance(value, np.ndarray)
        }
        return replace(self, **{name: array[own] for name, array in arrays.items()})

    def frame(self, index: int) -> "RegionTracks":
        """The tracks of one frame."""
        return self.frames(slice(index, index + 1))

    @property
    def visible(self) -> BoolArray:
        """(F, M) whether each marker was detected in each frame."""
        return np.asarray(np.isfinite(self.centroid[..., 0]))

    @property
    def frame_count(self) -> int:
        """Number of frames, F."""
        return len(self.time_s)


def is_variable_frame_rate(time_s: ArrayLike) -> bool:
    """Whether frames with these time stamps (F,) [s] are unevenly spaced in time.

    That is, whether an interval differs from the median by more than a tenth and more than the millisecond by
    which containers round. A dropped frame counts: Blender shows such clips by time, not by index.
    """
    intervals = np.diff(np.asarray(time_s, dtype=np.float64))
    if intervals.size < 2:
        return False
    median = float(np.median(intervals))
    return bool(np.abs(intervals - median).max() > max(0.1 * median, 1.1e-3))


@dataclass(frozen=True, eq=False)
class ExpectedRegions:
    """Expected region of each marker in each frame, to tell it from clutter of like hue."""

    center: Array  # (F, M, 2) px; NaN where unknown
    radius: Array  # (F, M) px, a generous bound of the centroid's distance from the center

    def __post_init__(self) -> None:
        frames, markers = self.radius.shape
        freeze(self, {"center": (frames, markers, 2), "radius": (frames, markers)})


class Regions(NamedTuple):
    """R connected regions of the markers' colors in one image, by color and from large to small."""

    color: IntArray  # (R,) index of the color of each
    moments: Array  # (R, 6) raw moments m00, m10, m01, m20, m11, m02 in pixels of the measuring grid
    box: IntArray  # (R, 4) left, top, right, bottom in its pixels
    certainty: Array  # (R,) mean probability of the pixels' color in 0..1
    clipped: BoolArray  # (R,) whether it touches the image's border

    def part(self, first: int, end: int) -> "Regions":
        """The regions from `first` to before `end`."""
        return Regions._make(array[first:end] for array in self)


NO_REGIONS = Regions(
    np.zeros(0, np.int64), np.zeros((0, 6)), np.zeros((0, 4), np.int64), np.zeros(0), np.zeros(0, np.bool_)
)


@dataclass(frozen=True)
class LearningRound:
    """One round of color learning."""

    frames: tuple[int, ...]  # indices of the frames learned from
    model_digest: str  # digest of the color model that was learned


@dataclass(frozen=True, eq=False)
class Detections:
    """All regions of the markers' colors in a clip of F frames."""

    regions: tuple[Regions, ...]  # regions of each frame, in pixels of the measuring grid
    time_s: Array  # (F,) time stamps of the frames in seconds
    size: tuple[int, int]  # width and height of the clip's images in px
    learning_rounds: tuple[LearningRound, ...]  # rounds in which the colors were learned, in order
    samples: Mapping[int, Image]  # the images (rows, columns, 3) that were learned from, by frame
