"""Marker styles: a marker's name, segment and color sample, and groups of markers that look alike."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from ..arrays import Array, BoolArray, Image
from .clips.clip_timing import is_variable_frame_rate
from .colors.color_learning import sample_distribution
from .segmentation.regions import Regions


@dataclass(frozen=True)
class MarkerStyle:
    """A colored surface marker as the performer wears it."""

    name: str  # the marker's name
    segment: str  # the body segment it is bound to
    color_srgb: tuple[int, int, int]  # one eyedropper sample of the footage, (red, green, blue) in 0..255


def color_groups(styles: Sequence[MarkerStyle]) -> list[list[int]]:
    """Group the indices of the markers by color; markers of indistinguishable colors are together."""
    groups: list[list[int]] = []
    for index, style in enumerate(styles):
        for group in groups:
            # Light may make them equal.
            if any(_distance(style.color_srgb, styles[other].color_srgb) < 2.5 for other in group):
                group.append(index)
                break
        else:
            groups.append([index])
    return groups


def _distance(first: tuple[int, int, int], second: tuple[int, int, int]) -> float:
    """Squared Mahalanobis distance of two samples, by the covariance of their difference."""
    one, other = sample_distribution(first), sample_distribution(second)
    offset = one.mean - other.mean
    squared = float(offset @ np.linalg.solve(one.covariance + other.covariance, offset))
    light = (one.log_luma - other.log_luma) ** 2
    return squared + light / (one.log_luma_deviation**2 + other.log_luma_deviation**2)


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
        tails: dict[str, tuple[int, ...]] = {
            "centroid": (frames, markers, 2),
            "second_moment": (frames, markers, 2, 2),
            "area": (frames, markers),
            "quality": (frames, markers),
            "clipped": (frames, markers),
            "time_s": (frames,),
        }
        for field in fields(self):
            if field.name not in tails:
                continue
            dtype = np.bool_ if field.name == "clipped" else np.float64
            array = np.array(getattr(self, field.name), dtype=dtype)
            if array.shape != tails[field.name]:
                raise ValueError(f"{field.name} has the shape {array.shape}, not {tails[field.name]}")
            array.setflags(write=False)
            object.__setattr__(self, field.name, array)

    @classmethod
    def unmarked(cls, time_s: Array, size: tuple[int, int]) -> "RegionTracks":
        """Tracks of a performer who wears no marker, M = 0, at the times (F,) [s]."""
        empty = np.zeros((len(time_s), 0))
        return cls(
            names=(),
            centroid=np.zeros((*empty.shape, 2)),
            second_moment=np.zeros((*empty.shape, 2, 2)),
            area=empty,
            quality=empty,
            clipped=empty.astype(bool),
            time_s=time_s,
            size=size,
        )

    def frame(self, index: int) -> "RegionTracks":
        """The tracks of one frame, its time included."""
        rows = {
            field.name: getattr(self, field.name)[index : index + 1]
            for field in fields(self)
            if isinstance(getattr(self, field.name), np.ndarray)
        }
        return replace(self, **rows)

    @property
    def visible(self) -> BoolArray:
        """(F, M) whether each marker was detected in each frame."""
        return np.asarray(np.isfinite(self.centroid[..., 0]))

    @property
    def frame_count(self) -> int:
        """Number of frames, F."""
        return len(self.time_s)

    @property
    def variable_frame_rate(self) -> bool:
        """Whether the frames are unevenly spaced in time, as phones record them."""
        return is_variable_frame_rate(self.time_s)


@dataclass(frozen=True, eq=False)
class ExpectedRegions:
    """Expected region of each marker in each frame, to tell it from clutter of like hue."""

    center: Array  # (F, M, 2) px; NaN where unknown
    radius: Array  # (F, M) px, a generous bound of the centroid's distance from the center

    def __post_init__(self) -> None:
        center = np.array(self.center, dtype=np.float64)
        radius = np.array(self.radius, dtype=np.float64)
        if center.ndim != 3 or center.shape[-1] != 2 or radius.shape != center.shape[:2]:
            raise ValueError(
                f"center must be (F, M, 2) and radius (F, M), not {center.shape} and {radius.shape}"
            )
        for name, array in (("center", center), ("radius", radius)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)


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
