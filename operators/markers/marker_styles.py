"""Markers between the scene's settings and core."""

from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError

if TYPE_CHECKING:
    from ...core.footage.marker_style import MarkerStyle

FULL_SCALE = 255


def marker_styles(take: bpy.types.PropertyGroup) -> "tuple[MarkerStyle, ...]":
    """A take's markers.

    Raises:
        InputError: Two markers have one name or one segment.
    """
    from ...core.footage.marker_style import MarkerStyle

    styles = tuple(
        MarkerStyle(marker.name, marker.segment, _to_bytes(marker.color)) for marker in take.markers
    )
    for kind, values in (("name", [s.name for s in styles]), ("segment", [s.segment for s in styles])):
        twice = next((value for value in values if values.count(value) > 1), None)
        if twice is not None:
            raise InputError(f"two markers have the {kind} '{twice}'; each needs its own")
    return styles


def picked_styles(take: bpy.types.PropertyGroup) -> "tuple[MarkerStyle, ...]":
    """Those of a take's markers that were given a color.

    Raises:
        InputError: Two markers have one name or one segment.
    """
    pairs = zip(take.markers, marker_styles(take), strict=True)
    return tuple(style for marker, style in pairs if marker.is_picked)


def set_marker_color(marker: bpy.types.PropertyGroup, color_srgb: tuple[int, int, int]) -> None:
    """Set a marker's color from bytes."""
    marker.color = [value / FULL_SCALE for value in color_srgb]


def _to_bytes(color: bpy.types.bpy_prop_array) -> tuple[int, int, int]:
    red, green, blue = (round(float(value) * FULL_SCALE) for value in color)
    return red, green, blue
