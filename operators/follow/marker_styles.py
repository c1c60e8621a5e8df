"""A take's markers as styles of color and segment, as the search takes them; new markers of the list."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from bpy.types import PropertyGroup

from ...core.errors import InputError, pluralize
from ..shell.footage_view import clip_index
from ..shell.results import reading_of
from ..shell.takes import unique_name

if TYPE_CHECKING:
    from ...core.markers.region_tracks import MarkerStyle

Rgb = tuple[int, int, int]  # Red, green, blue in 0 to 255

USUAL_SEGMENTS = ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
"""The five segments whose markers help most, in the order in which they are offered."""


def append_marker(take: PropertyGroup, segment: str) -> None:
    """Add a marker with a unique name after its segment, and make it the active one."""
    name = unique_name(segment, [marker.name for marker in take.markers])
    marker = take.markers.add()
    marker.segment, marker.name = segment, name
    marker.named_after = segment
    take.active_marker = len(take.markers) - 1


def append_usual_markers(take: PropertyGroup) -> None:
    """Add those of the usual five that are missing; the first of them becomes the active one."""
    marked, first = {marker.segment for marker in take.markers}, len(take.markers)
    for segment in USUAL_SEGMENTS:
        if segment not in marked:
            append_marker(take, segment)
    take.active_marker = first


def marker_styles(take: PropertyGroup) -> "tuple[MarkerStyle, ...]":
    """Return the styles of a take's markers.

    Raises:
        InputError: Two markers have one name or one segment.
    """
    from ...core.markers.region_tracks import MarkerStyle

    styles = []
    for marker in take.markers:
        red, green, blue = (round(float(value) * 255) for value in marker.color)
        styles.append(MarkerStyle(marker.name, marker.segment, (red, green, blue)))
    for kind in ("name", "segment"):
        values = [getattr(style, kind) for style in styles]
        twice = next((value for value in values if values.count(value) > 1), None)
        if twice is not None:
            raise InputError(f"two markers have the {kind} '{twice}'; each needs its own")
    return tuple(styles)


def styles_with_colors(take: PropertyGroup, colors: Mapping[str, Rgb]) -> "tuple[MarkerStyle, ...]":
    """The styles of a take's markers that have a color, once some are given new ones by their names.

    A take without markers counts as one with the usual five.

    Raises:
        InputError: Two markers have one name or one segment, or there is no marker of a name.
    """
    from ...core.markers.region_tracks import MarkerStyle

    styles, picked = marker_styles(take), {marker.name for marker in take.markers if marker.is_picked}
    if not styles:
        styles = tuple(MarkerStyle(segment, segment, (0, 0, 0)) for segment in USUAL_SEGMENTS)
    unknown = set(colors) - {style.name for style in styles}
    if unknown:
        known = ", ".join(style.name for style in styles)
        raise InputError(f"no marker is called '{min(unknown)}'; the markers are {known}")
    return tuple(
        replace(style, color_srgb=colors.get(style.name, style.color_srgb))
        for style in styles
        if style.name in colors or style.name in picked
    )


def set_marker_color(marker: PropertyGroup, color_srgb: Rgb) -> None:
    """Set a marker's color from bytes."""
    marker.color = [value / 255 for value in color_srgb]


def markers_label(take: PropertyGroup) -> str:
    """As in `4 of 5`, once the clip was read for these markers; before that how many there are."""
    count = len(take.markers)
    if not count or take.clip is None:
        return ""
    reading, index = reading_of(take), clip_index(take)
    names = tuple(marker.name for marker in take.markers)
    if reading is None or reading.tracks.names != names or not 0 <= index < reading.tracks.frame_count:
        return pluralize(count, "marker")
    return f"{int(reading.tracks.visible[index].sum())} of {count}"
