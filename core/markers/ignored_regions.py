"""Ignored regions: parts of the picture that are never a marker, whatever color they have.

A box, or the stroke of a brush, in all frames of a clip or some. Their pixels are neither searched for
markers, nor learned from, nor counted as background: a wall of a marker's very color says nothing of either.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Annotated, Any

import numpy as np

from ..arrays import BoolArray, Image
from ..camera.camera_fields import LARGEST_SIDE_PX
from ..errors import InputError, shown
from ..files.kinds import Items, Number, Whole
from ..files.records import Record

IGNORED = 255  # value of ignored pixels in a mask; of one made smaller, pixels from half of it on are ignored

PixelBox = tuple[float, float, float, float]  # left, top, right, bottom in pixels of the footage


IGNORED_REGIONS = "ignored_regions"
MOST_REGIONS = 200
MOST_POINTS = 1000  # points of one stroke
VALID_BOX = "[left, top, right, bottom] in pixels of the footage, as in [10, 20, 60, 90]"
VALID_STROKE = f"a list of 1 to {MOST_POINTS} points [x, y] in pixels of the footage"
VALID_FRAMES = "[first, last], scene frames in order"

SceneFrame = Annotated[int, Whole(-(10**7), 10**7)]
Coordinate = Annotated[float, Number(-LARGEST_SIDE_PX, 2 * LARGEST_SIDE_PX)]
PixelPoint = Annotated[tuple[Coordinate, ...], Items("numbers", 2, 2)]


@dataclass(frozen=True)
class IgnoredRegion(Record):
    """A region of the picture that is never a marker: a box, or the stroke of a brush."""

    STRICT = True

    box: Annotated[tuple[Coordinate, ...], Items("numbers", 4, 4, VALID_BOX)] | None = None
    """Left, top, right, bottom [px]."""
    stroke: Annotated[tuple[PixelPoint, ...], Items("points", 1, MOST_POINTS, VALID_STROKE)] | None = None
    """Points [x, y] of a brush's path [px]."""
    radius_px: Annotated[float, Number(0.5, LARGEST_SIDE_PX, "pixels of the footage")] | None = None
    """Radius of the brush [px]."""
    frames: Annotated[tuple[SceneFrame, ...], Items("frames", 2, 2, VALID_FRAMES)] | None = None
    """First and last scene frame in which it is ignored; the default is all."""  # indices once read

    def mistake(self) -> str:
        """See `Record`."""
        if self.frames is not None and self.frames[0] > self.frames[1]:
            return f"frames is {shown(list(self.frames))}; it must be {VALID_FRAMES}"
        if self.stroke is not None and self.box is not None:
            return "has a box and a stroke; each region has one of them"
        if self.stroke is not None and self.radius_px is None:
            return "radius_px is missing; it must be a number of pixels of the footage, from 0.5"
        if self.stroke is None and self.radius_px is not None:
            return f"has a radius_px without a stroke, {VALID_STROKE}"
        return "" if self.box or self.stroke else f"box is missing; it must be {VALID_BOX}"


@dataclass(frozen=True)
class IgnoredPixels:
    """The ignored pixels of a clip, frame by frame."""

    regions: tuple[IgnoredRegion, ...]
    size: tuple[int, int]  # width and height of the footage in px
    sampled: tuple[int, ...] | None = None
    """Index in the clip of each frame that is asked for; None where frames are the clip's own."""

    def mask(self, frame: int) -> Image | None:
        """Mask (rows, columns) of a frame on the measuring grid, IGNORED or 0; None if all is searched."""
        if not self.regions:
            return None
        index = frame if self.sampled is None else self.sampled[frame]
        all_frames = (index, index)
        spans = [(region, region.frames or all_frames) for region in self.regions]
        here = tuple(region for region, (first, last) in spans if first <= index <= last)
        return _mask(here, self.size) if here else None


def is_ignored(mask: Image) -> BoolArray:
    """(rows, columns) which pixels of a mask, made smaller or not, are ignored."""
    return np.asarray(2 * mask.astype(np.int64) > IGNORED)


def without(label: Image, mask: Image, nothing: int) -> Image:
    """Labels of an image's pixels, `nothing` where they are ignored."""
    return np.where(is_ignored(mask), np.uint8(nothing), label)


@lru_cache(16)  # a session's, some hundred kilobytes each
def _mask(regions: tuple[IgnoredRegion, ...], size: tuple[int, int]) -> Image:
    """The pixels of the measuring grid whose centers lie in any of the regions."""
    import cv2  # late: Blender registers without it

    from ..video.working_image import halvings

    step_px, ignored = 1 << halvings(size), (float(IGNORED),)
    mask = np.zeros((size[1] // step_px, size[0] // step_px), dtype=np.uint8)
    for region in regions:
        if region.box is not None:
            left, top, right, bottom = (max(round(value / step_px), 0) for value in region.box)
            mask[top:bottom, left:right] = IGNORED
            continue
        # OpenCV counts from the center of the first pixel, Keymark from its corner. It draws with sixteenths
        # of a pixel (shift=4).
        path = np.round((np.array(region.stroke) / step_px - 0.5) * 16).astype(np.int32)
        radius = max(round((region.radius_px or 0.0) / step_px * 16), 8)
        for x, y in path.tolist():
            cv2.circle(mask, (x, y), radius, ignored, -1, shift=4)
        for one, other in itertools.pairwise(path.astype(np.float64)):  # what the disc sweeps in between
            along = other - one
            length = float(np.linalg.norm(along))
            if length > 0.0:
                across = float(radius) / length * np.array([-along[1], along[0]])
                corners = np.round([one + across, other + across, other - across, one - across])
                cv2.fillConvexPoly(mask, corners.astype(np.int32), ignored, shift=4)
    mask.setflags(write=False)
    return mask


def ignored_regions(
    regions: Sequence[IgnoredRegion], size: tuple[int, int], frame_start: int, source: str
) -> tuple[IgnoredRegion, ...]:
    """Regions of a take, as `source` gives them, for footage of (width, height)."""
    for number, region in enumerate(regions):
        if region.box is None:
            continue
        where = f"{source}: {IGNORED_REGIONS}[{number}]"
        left, top, right, bottom = region.box
        sides = shown([int(part) if part.is_integer() else part for part in region.box])
        if left >= right or top >= bottom:
            raise InputError(f"{where}: box is {sides}, which holds no pixel; it must be {VALID_BOX}")
        if left >= size[0] or top >= size[1] or right <= 0.0 or bottom <= 0.0:
            picture = f"the picture of {size[0]} x {size[1]} pixels"
            raise InputError(f"{where}: box is {sides}, which lies beside {picture}")
    return tuple(_later(region, -frame_start) for region in regions)


def ignored_region_fields(regions: Sequence[IgnoredRegion], frame_start: int) -> list[dict[str, Any]]:
    """Regions as the field `ignored_regions` of `take.json`."""
    return [_later(region, frame_start).to_json() for region in regions]


def _later(region: IgnoredRegion, by: int) -> IgnoredRegion:
    """A region whose frames have numbers larger by so many."""
    return region if region.frames is None else replace(region, frames=tuple(at + by for at in region.frames))
