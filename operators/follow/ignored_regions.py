"""Regions of the picture that are never a marker: from a take in the scene to core's, and back."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

import bpy

from ..shell.takes import unique_name

if TYPE_CHECKING:
    from ...core.markers.ignored_regions import IgnoredRegion


PLACES = 2  # Decimals of a pixel that files keep: Blender's own numbers are of single precision
BRUSHED, BOXED = "Brushed", "Still Area"


def ignored_regions(take: bpy.types.PropertyGroup) -> "tuple[IgnoredRegion, ...]":
    """The regions of a take."""
    return tuple(_to_core(region) for region in take.ignored_regions)


def add_ignored_regions(take: bpy.types.PropertyGroup, regions: "Iterable[IgnoredRegion]") -> None:
    """Add regions to a take; the last becomes the active one."""
    for region in regions:
        name = BOXED if region.box is not None else BRUSHED
        name = unique_name(name, (other.name for other in take.ignored_regions))
        _to_scene(take.ignored_regions.add(), region, name, take)
        take.active_ignored = len(take.ignored_regions) - 1


def ignored_pixels_key(take: bpy.types.PropertyGroup) -> tuple[object, ...]:
    """What previews of a take's markers depend on beside the markers, quick to compare."""
    return tuple(
        (
            tuple(region.box),
            len(region.stroke),
            *(tuple(point.pixel) for point in region.stroke),
            region.radius,
            region.some_frames and (region.first, region.last),
        )
        for region in take.ignored_regions
    )


def _to_core(region: bpy.types.PropertyGroup) -> "IgnoredRegion":
    from ...core.markers.ignored_regions import IgnoredRegion

    frames = (int(region.first), int(region.last)) if region.some_frames else None
    if not len(region.stroke):
        left, top, right, bottom = (round(float(value), PLACES) for value in region.box)
        return IgnoredRegion(box=(left, top, right, bottom), frames=frames)
    pixels = ([round(float(value), PLACES) for value in point.pixel] for point in region.stroke)
    radius = round(float(region.radius), PLACES)
    return IgnoredRegion(stroke=tuple((x, y) for x, y in pixels), radius_px=radius, frames=frames)


def _to_scene(
    made: bpy.types.PropertyGroup, region: "IgnoredRegion", name: str, take: bpy.types.PropertyGroup
) -> None:
    made.name = name
    if region.box is not None:
        made.box = region.box
    for pixel in region.stroke:
        made.stroke.add().pixel = pixel
    made.radius = region.radius_px
    length = take.clip.frame_duration if take.clip is not None else 1
    made.first, made.last = region.frames or (0, max(length - 1, 0))
    made.some_frames = region.frames is not None
