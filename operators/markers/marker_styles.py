"""Marker styles: from a take's markers in the scene to core's, and back."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from .new_markers import USUAL_SEGMENTS

if TYPE_CHECKING:
    from ...core.footage.marker_style import MarkerStyle

FULL_SCALE = 255

Rgb = tuple[int, int, int]
"""Red, green, blue in 0 to 255."""


def marker_styles(take: bpy.types.PropertyGroup) -> "tuple[MarkerStyle, ...]":
    """Return the styles of a take's markers.

    Raises:
        InputError: Two markers have one name or one segment.
    """
    styles = tuple(_style(marker.name, marker.segment, _to_bytes(marker.color)) for marker in take.markers)
    for kind, values in (("name", [s.name for s in styles]), ("segment", [s.segment for s in styles])):
        twice = next((value for value in values if values.count(value) > 1), None)
        if twice is not None:
            raise InputError(f"two markers have the {kind} '{twice}'; each needs its own")
    return styles


def picked_styles(take: bpy.types.PropertyGroup) -> "tuple[MarkerStyle, ...]":
    """Return the styles of a take's markers that have a color.

    Raises:
        InputError: Two markers have one name or one segment.
    """
    pairs = zip(take.markers, marker_styles(take), strict=True)
    return tuple(style for marker, style in pairs if marker.is_picked)


def styles_with_colors(take: bpy.types.PropertyGroup, colors: Mapping[str, Rgb]) -> "tuple[MarkerStyle, ...]":
    """The styles of a take's markers that have a color, once some are given new ones.

    Args:
        take: The take; without a marker it counts as one with the usual five.
        colors: The new colors, by the markers' names.

    Raises:
        InputError: Two markers have one name or one segment, or there is no marker of a name.
    """
    styles, picked = marker_styles(take), {marker.name for marker in take.markers if marker.is_picked}
    if not styles:
        styles = tuple(_style(segment, segment, (0, 0, 0)) for segment in USUAL_SEGMENTS)
    unknown = set(colors) - {style.name for style in styles}
    if unknown:
        known = ", ".join(style.name for style in styles)
        raise InputError(f"no marker is called '{min(unknown)}'; the markers are {known}")
    return tuple(
        replace(style, color_srgb=colors.get(style.name, style.color_srgb))
        for style in styles
        if style.name in colors or style.name in picked
    )


def set_marker_color(marker: bpy.types.PropertyGroup, color_srgb: Rgb) -> None:
    """Set a marker's color from bytes."""
    marker.color = [value / FULL_SCALE for value in color_srgb]


def _style(name: str, segment: str, color_srgb: Rgb) -> "MarkerStyle":
    from ...core.footage.marker_style import MarkerStyle

    return MarkerStyle(name, segment, color_srgb)


def _to_bytes(color: bpy.types.bpy_prop_array) -> Rgb:
    red, green, blue = (round(float(value) * FULL_SCALE) for value in color)
    return red, green, blue
