"""Marker styles: from a take's markers in the scene to core's, and back."""

from dataclasses import replace
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from .new_markers import free_name, next_segment

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


def styles_with_color(
    take: bpy.types.PropertyGroup, index: int | None, color: Rgb
) -> "tuple[MarkerStyle, ...]":
    """Return the styles of a take's markers that have a color, once one of them is given a new color.

    Args:
        take: The take.
        index: The marker that is given the color; None for a new marker, which comes last.
        color: The color.

    Raises:
        InputError: Two markers have one name or one segment, or all segments have markers.
    """
    styles = [
        replace(style, color_srgb=color) if number == index else style
        for number, style in enumerate(marker_styles(take))
        if number == index or take.markers[number].is_picked
    ]
    if index is None:
        segment = next_segment(take)
        if segment is None:
            raise InputError("every body part has a marker already; choose the one to pick a color for")
        styles.append(_style(free_name(take, segment), segment, color))
    return tuple(styles)


def set_marker_color(marker: bpy.types.PropertyGroup, color_srgb: Rgb) -> None:
    """Set a marker's color from bytes."""
    marker.color = [value / FULL_SCALE for value in color_srgb]


def _style(name: str, segment: str, color_srgb: Rgb) -> "MarkerStyle":
    from ...core.footage.marker_style import MarkerStyle

    return MarkerStyle(name, segment, color_srgb)


def _to_bytes(color: bpy.types.bpy_prop_array) -> Rgb:
    red, green, blue = (round(float(value) * FULL_SCALE) for value in color)
    return red, green, blue
