"""Ignored regions: parts of the picture that are never a marker, whatever color they have.

A box, or the stroke of a brush, in all frames of a clip or some. Their pixels are neither searched for
markers, nor learned from, nor counted as background: a wall of a marker's very color says nothing of either.
"""

import itertools
from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np

from ..arrays import Array, BoolArray, Image
from .segmentation.working_image import halvings

IGNORED = 255
"""Value of ignored pixels in a mask; of one made smaller, pixels from half of it on are ignored."""
SUBPIXEL_BITS = 4
SUBPIXELS = 1 << SUBPIXEL_BITS
"""Parts of a pixel in drawn coordinates."""
MOST_MASKS = 16
"""Masks of a session that are kept, some hundred kilobytes each."""

Point = tuple[float, float]
PixelBox = tuple[float, float, float, float]
"""Left, top, right, bottom in pixels of the footage."""


@dataclass(frozen=True)
class IgnoredRegion:
    """One region of the picture that is never a marker, in pixels of the footage."""

    box: PixelBox | None = None
    """A box; None for a stroke."""
    stroke: tuple[Point, ...] = ()
    """Points of a brush's path, all pixels within the radius of which are ignored."""
    radius_px: float = 0.0
    """The brush's radius."""
    frames: tuple[int, int] | None = None
    """Index of the first frame and of the last one; None for all."""

    def holds_in(self, frame: int) -> bool:
        """Whether it is ignored in a frame of the clip, by its index."""
        return self.frames is None or self.frames[0] <= frame <= self.frames[1]


@dataclass(frozen=True)
class IgnoredPixels:
    """The ignored pixels of a clip, frame by frame."""

    regions: tuple[IgnoredRegion, ...]
    size: tuple[int, int]
    """Width and height of the footage in px."""
    sampled: tuple[int, ...] | None = None
    """Index in the clip of each frame that is asked for; None where frames are the clip's own."""

    def mask(self, frame: int) -> Image | None:
        """Mask (rows, columns) of a frame on the measuring grid, IGNORED or 0; None if all is searched."""
        if not self.regions:
            return None
        index = frame if self.sampled is None else self.sampled[frame]
        here = tuple(region for region in self.regions if region.holds_in(index))
        return _mask(here, self.size) if here else None


def is_ignored(mask: Image) -> BoolArray:
    """(rows, columns) which pixels of a mask, made smaller or not, are ignored."""
    return np.asarray(2 * mask.astype(np.int64) > IGNORED)


def without(label: Image, mask: Image, nothing: int) -> Image:
    """Labels of an image's pixels, `nothing` where they are ignored."""
    return np.where(is_ignored(mask), np.uint8(nothing), label)


@lru_cache(MOST_MASKS)
def _mask(regions: tuple[IgnoredRegion, ...], size: tuple[int, int]) -> Image:
    """The pixels of the measuring grid whose centers lie in any of the regions."""
    times = halvings(size)
    mask = np.zeros((size[1] >> times, size[0] >> times), dtype=np.uint8)
    for region in regions:
        _draw(mask, region, float(1 << times))
    mask.setflags(write=False)
    return mask


def _draw(mask: Image, region: IgnoredRegion, step_px: float) -> None:
    """Fill a region in a mask (rows, columns), whose pixels are `step_px` pixels of the footage wide."""
    if region.box is not None:
        left, top, right, bottom = (max(round(value / step_px), 0) for value in region.box)
        mask[top:bottom, left:right] = IGNORED
        return
    # OpenCV counts from the center of the first pixel, Keymark from its corner.
    path = np.round((np.array(region.stroke) / step_px - 0.5) * SUBPIXELS).astype(np.int32)
    radius = max(round(region.radius_px / step_px * SUBPIXELS), SUBPIXELS // 2)
    for x, y in path.tolist():
        cv2.circle(mask, (x, y), radius, (float(IGNORED),), -1, shift=SUBPIXEL_BITS)
    for one, other in itertools.pairwise(path.astype(np.float64)):
        _draw_between(mask, one, other, float(radius))


def _draw_between(mask: Image, one: Array, other: Array, radius: float) -> None:
    """Fill what a disc sweeps on its way between two points, all in parts of a pixel."""
    along = other - one
    length = float(np.linalg.norm(along))
    if length > 0.0:
        across = radius / length * np.array([-along[1], along[0]])
        corners = np.round([one + across, other + across, other - across, one - across]).astype(np.int32)
        cv2.fillConvexPoly(mask, corners, (float(IGNORED),), shift=SUBPIXEL_BITS)
