"""Tracks of the markers' image regions, and the regions expected beforehand."""

from dataclasses import dataclass, fields, replace

import numpy as np

from ..arrays import Array, BoolArray
from .clips.clip_timing import is_variable_frame_rate


@dataclass(frozen=True, eq=False)
class RegionTracks:
    """The markers' image regions over a clip of F frames and M markers; NaN where a marker is hidden."""

    names: tuple[str, ...]
    """The markers, in the order of the second axis."""
    centroid: Array
    """(F, M, 2) px, origin at the outer corner of the top left pixel."""
    second_moment: Array
    """(F, M, 2, 2) px², the second central moment matrix A of eq. 2."""
    area: Array
    """(F, M) px."""
    quality: Array
    """(F, M) in 0..1; confidence that the region is the whole marker and nothing else, 0 where hidden."""
    clipped: BoolArray
    """(F, M) whether the region touches the image's border."""
    time_s: Array
    """(F,) time stamps of the frames in seconds, from the first frame."""
    size: tuple[int, int]
    """Width and height of the image in px."""
    notes: tuple[str, ...] = ()
    """Sentences on possible faults of the tracks."""

    def __post_init__(self) -> None:
        """Check the shapes and keep own, read-only copies.

        Raises:
            ValueError: Shapes disagree.
        """
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
        """Tracks of a performer who wears no marker, M = 0.

        Args:
            time_s: (F,) time stamps of the frames in seconds.
            size: Width and height of the image [px].
        """
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

    center: Array
    """(F, M, 2) px; NaN where unknown."""
    radius: Array
    """(F, M) px, a generous bound of the centroid's distance from the center."""

    def __post_init__(self) -> None:
        """Check the shapes and keep own, read-only copies.

        Raises:
            ValueError: Shapes disagree.
        """
        center = np.array(self.center, dtype=np.float64)
        radius = np.array(self.radius, dtype=np.float64)
        if center.ndim != 3 or center.shape[-1] != 2 or radius.shape != center.shape[:2]:
            raise ValueError(
                f"center must be (F, M, 2) and radius (F, M), not {center.shape} and {radius.shape}"
            )
        for name, array in (("center", center), ("radius", radius)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)
