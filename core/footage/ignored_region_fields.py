"""Ignored regions as the field `ignored_regions` of `take.json`."""

from collections.abc import Sequence
from typing import Any

from ..errors import InputError
from ..files.fields import Fields, is_number
from ..files.json_file import shown
from .ignored_regions import IgnoredRegion

IGNORED_REGIONS = "ignored_regions"
KNOWN = ("box", "stroke", "radius_px", "frames")
MOST_REGIONS = 200
MOST_POINTS = 1000
"""Points of one stroke."""
VALID = 'a list of regions that are never a marker, as in [{"box": [10, 20, 60, 90]}]'
VALID_BOX = "[left, top, right, bottom] in pixels of the footage, as in [10, 20, 60, 90]"
VALID_STROKE = f"a list of 1 to {MOST_POINTS} points [x, y] in pixels of the footage"
VALID_FRAMES = "[first, last], scene frames in order"
FARTHEST_FRAME = 10**7


def read_ignored_regions(
    fields: Fields, size: tuple[int, int], frame_start: int
) -> tuple[IgnoredRegion, ...]:
    """The regions of a take's fields; none where it has no such field.

    Args:
        fields: The take's fields.
        size: Width and height of its footage in px.
        frame_start: Scene frame of the clip's first frame.

    Raises:
        InputError: One is not what it must be, or lies beside the picture.
    """
    if not fields.has(IGNORED_REGIONS):
        return ()
    source, value = fields.source_of(IGNORED_REGIONS), fields.required(IGNORED_REGIONS, VALID)
    if not isinstance(value, list):
        raise InputError(f"{source}: {IGNORED_REGIONS} is {shown(value)}; it must be {VALID}")
    if len(value) > MOST_REGIONS:
        raise InputError(
            f"{source}: {IGNORED_REGIONS} has {len(value)} regions; at most {MOST_REGIONS} are read"
        )
    where = [f"{source}: {IGNORED_REGIONS}[{number}]" for number in range(len(value))]
    return tuple(_region(Fields.of(one, at), size, frame_start) for one, at in zip(value, where, strict=True))


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


def _region(fields: Fields, size: tuple[int, int], frame_start: int) -> IgnoredRegion:
    fields.refuse_others(KNOWN)
    frames = _frames(fields, frame_start)
    if fields.has("stroke"):
        if fields.has("box"):
            raise InputError(f"{fields.where} has a box and a stroke; each region has one of them")
        return _stroke(fields, size, frames)
    if fields.has("radius_px"):
        raise InputError(f"{fields.where} has a radius_px without a stroke, {VALID_STROKE}")
    return IgnoredRegion(box=_box(fields, size), frames=frames)


def _box(fields: Fields, size: tuple[int, int]) -> tuple[float, float, float, float]:
    width, height = size
    farthest = float(max(size))
    left, top, right, bottom = fields.numbers("box", 4, -farthest, 2.0 * farthest, VALID_BOX)
    said = shown(fields.values["box"])
    if left >= right or top >= bottom:
        raise InputError(f"{fields.where}: box is {said}, which holds no pixel; it must be {VALID_BOX}")
    if left >= width or top >= height or right <= 0.0 or bottom <= 0.0:
        raise InputError(
            f"{fields.where}: box is {said}, which lies beside the picture of {width} x {height} pixels"
        )
    return left, top, right, bottom


def _stroke(fields: Fields, size: tuple[int, int], frames: tuple[int, int] | None) -> IgnoredRegion:
    value = fields.required("stroke", VALID_STROKE)
    farthest = max(size)
    usable = isinstance(value, list) and 1 <= len(value) <= MOST_POINTS
    if not usable or not all(_is_point(point, farthest) for point in value):
        raise InputError(f"{fields.where}: stroke is {shown(value)}; it must be {VALID_STROKE}")
    radius = fields.number("radius_px", 0.5, float(farthest), "pixels of the footage")
    return IgnoredRegion(
        stroke=tuple((float(x), float(y)) for x, y in value), radius_px=radius, frames=frames
    )


def _is_point(value: Any, farthest: int) -> bool:
    """Whether a value is a point in the picture or not far beside it."""
    return (
        isinstance(value, list)
        and len(value) == 2
        and all(is_number(number) and -farthest <= number <= 2 * farthest for number in value)
    )


def _frames(fields: Fields, frame_start: int) -> tuple[int, int] | None:
    if not fields.has("frames"):
        return None
    first, last = fields.numbers("frames", 2, -FARTHEST_FRAME, FARTHEST_FRAME, VALID_FRAMES)
    if first != int(first) or last != int(last) or first > last:
        said = shown(fields.values["frames"])
        raise InputError(f"{fields.where}: frames is {said}; it must be {VALID_FRAMES}")
    return int(first) - frame_start, int(last) - frame_start
