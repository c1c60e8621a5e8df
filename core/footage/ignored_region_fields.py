"""Ignored regions as the field `ignored_regions` of `take.json`."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from ..errors import InputError
from ..files.json_file import shown
from ..files.kinds import Items, Number, Whole, refuse
from ..files.records import Record
from .camera_fields import LARGEST_SIDE_PX
from .ignored_regions import IgnoredRegion

IGNORED_REGIONS = "ignored_regions"
MOST_REGIONS = 200
MOST_POINTS = 1000
"""Points of one stroke."""
VALID_BOX = "[left, top, right, bottom] in pixels of the footage, as in [10, 20, 60, 90]"
VALID_STROKE = f"a list of 1 to {MOST_POINTS} points [x, y] in pixels of the footage"
VALID_FRAMES = "[first, last], scene frames in order"
FARTHEST_FRAME = 10**7


Coordinate = Annotated[float, Number(-LARGEST_SIDE_PX, 2 * LARGEST_SIDE_PX)]
PixelPoint = Annotated[tuple[Coordinate, ...], Items("numbers", 2, 2)]


@dataclass(frozen=True)
class RegionFields(Record):
    """A region of the picture that is never a marker: a box, or the stroke of a brush."""

    STRICT = True

    box: Annotated[tuple[Coordinate, ...], Items("numbers", 4, 4, VALID_BOX)] | None = None
    """Left, top, right, bottom [px]."""
    stroke: Annotated[tuple[PixelPoint, ...], Items("points", 1, MOST_POINTS, VALID_STROKE)] | None = None
    """Points [x, y] of a brush's path [px]."""
    radius_px: Annotated[float, Number(0.5, LARGEST_SIDE_PX, "pixels of the footage")] | None = None
    """Radius of the brush [px]."""
    frames: (
        Annotated[
            tuple[Annotated[int, Whole(-FARTHEST_FRAME, FARTHEST_FRAME)], ...],
            Items("frames", 2, 2, VALID_FRAMES),
        ]
        | None
    ) = None
    """First and last scene frame in which it is ignored; the default is all."""

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


def ignored_regions(
    regions: Sequence[RegionFields], size: tuple[int, int], frame_start: int, source: str
) -> tuple[IgnoredRegion, ...]:
    """Regions of a take, from its fields.

    Args:
        regions: The fields.
        size: Width and height of the footage in px.
        frame_start: Scene frame of the clip's first frame.
        source: The file that gives them.

    Raises:
        InputError: One lies beside the picture.
    """
    where = [f"{source}: {IGNORED_REGIONS}[{number}]" for number in range(len(regions))]
    return tuple(_region(one, size, frame_start, at) for one, at in zip(regions, where, strict=True))


def ignored_region_fields(regions: Sequence[IgnoredRegion], frame_start: int) -> list[dict[str, Any]]:
    """Regions as the field that `read_ignored_regions` reads."""
    return [_fields(region, frame_start) for region in regions]


def _fields(region: IgnoredRegion, frame_start: int) -> dict[str, Any]:
    said: dict[str, Any] = {}
    if region.box is not None:
        said["box"] = list(region.box)
    else:
        said |= {"stroke": [list(point) for point in region.stroke], "radius_px": region.radius_px}
    if region.frames is not None:
        said["frames"] = [index + frame_start for index in region.frames]
    return said


def _region(region: RegionFields, size: tuple[int, int], frame_start: int, where: str) -> IgnoredRegion:
    frames = None
    if region.frames is not None:
        first, last = (frame - frame_start for frame in region.frames)
        frames = (first, last)
    farthest = max(size)
    points = [*(region.box or ()), *(part for point in region.stroke or () for part in point)]
    if any(not -farthest <= part <= 2 * farthest for part in points):
        if region.box is not None:
            refuse(where, "box", list(region.box), VALID_BOX)
        refuse(where, "stroke", [list(point) for point in region.stroke or ()], VALID_STROKE)
    if region.box is None:
        if (region.radius_px or 0.0) > farthest:
            valid = f"a number from 0.5 to {farthest} pixels of the footage"
            refuse(where, "radius_px", region.radius_px, valid)
        stroke = tuple((x, y) for x, y in region.stroke or ())
        return IgnoredRegion(stroke=stroke, radius_px=region.radius_px or 0.0, frames=frames)
    left, top, right, bottom = region.box
    said = shown([int(part) if part.is_integer() else part for part in region.box])
    if left >= right or top >= bottom:
        raise InputError(f"{where}: box is {said}, which holds no pixel; it must be {VALID_BOX}")
    if left >= size[0] or top >= size[1] or right <= 0.0 or bottom <= 0.0:
        raise InputError(
            f"{where}: box is {said}, which lies beside the picture of {size[0]} x {size[1]} pixels"
        )
    return IgnoredRegion(box=(left, top, right, bottom), frames=frames)
