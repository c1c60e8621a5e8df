"""Styles of a take's markers, and the search for the markers in its footage."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ...core.progress import within
from ..bridge.footage import Footage
from ..footage.take_footage import update_clip_digest
from ..shell.base_operator import capitalized
from ..shell.footage_view import FootageRequest, clip_index, side_of
from ..shell.results import reading_of
from ..shell.takes import active_take, footage_of, redraw_footage, take_by_identifier
from .ignored_regions import add_ignored_regions, ignored_regions
from .marker_list import USUAL_SEGMENTS, append_usual_markers
from .marker_properties import segment_title
from .mask_previews import keep_preview, show_masks, update_shown_masks

if TYPE_CHECKING:
    from ...core.markers.ignored_regions import IgnoredRegion
    from ...core.markers.marker_check import MarkerCheck
    from ...core.markers.region_tracks import MarkerStyle
    from ...core.progress import Job
    from ...core.video.clip import ClipSamples


def request_for(segment: str) -> FootageRequest:
    """The request for the marker on a segment; left and right are the performer's own."""
    return FootageRequest(f"Click on: {segment_title(segment)}", side_of(segment))


Rgb = tuple[int, int, int]  # Red, green, blue in 0 to 255


def marker_styles(take: bpy.types.PropertyGroup) -> "tuple[MarkerStyle, ...]":
    """Return the styles of a take's markers.

    Raises:
        InputError: Two markers have one name or one segment.
    """
    from ...core.markers.region_tracks import MarkerStyle

    styles = []
    for marker in take.markers:
        red, green, blue = (round(float(value) * 255) for value in marker.color)
        styles.append(MarkerStyle(marker.name, marker.segment, (red, green, blue)))
    for kind, values in (("name", [s.name for s in styles]), ("segment", [s.segment for s in styles])):
        twice = next((value for value in values if values.count(value) > 1), None)
        if twice is not None:
            raise InputError(f"two markers have the {kind} '{twice}'; each needs its own")
    return tuple(styles)


def styles_with_colors(take: bpy.types.PropertyGroup, colors: Mapping[str, Rgb]) -> "tuple[MarkerStyle, ...]":
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


def set_marker_color(marker: bpy.types.PropertyGroup, color_srgb: Rgb) -> None:
    """Set a marker's color from bytes."""
    marker.color = [value / 255 for value in color_srgb]


def markers_label(take: bpy.types.PropertyGroup) -> str:
    """As in `4 of 5`, once the clip was read for these markers; before that how many there are."""
    count = len(take.markers)
    if not count or take.clip is None:
        return ""
    reading = reading_of(take)
    names = tuple(marker.name for marker in take.markers)
    index = clip_index(take)
    if reading is None or reading.tracks.names != names or not 0 <= index < reading.tracks.frame_count:
        return "1 marker" if count == 1 else f"{count} markers"
    return f"{int(reading.tracks.visible[index].sum())} of {count}"


_samples: "dict[str, ClipSamples]" = {}
"""Sampled frames of the last two clips, some megabytes each, by the digest of the file: the latest last."""


def find_markers(
    footage: Footage, styles: "tuple[MarkerStyle, ...]", ignored: "tuple[IgnoredRegion, ...]"
) -> "Job[MarkerCheck]":
    """Find markers in frames sampled over a clip, which are decoded once a session."""
    from ...core.markers.marker_check import check_markers
    from ...core.markers.reading import footage_digest
    from ...core.video.clip import sample_clip

    key = footage_digest(footage.path)
    samples = _samples.pop(key, None)
    if samples is None:
        job = sample_clip(footage.open())
        samples = yield from within("Looking at frames of the clip", job, 0.0, 0.7)
    _samples[key] = samples
    while len(_samples) > 2:
        del _samples[next(iter(_samples))]
    check = check_markers(samples, styles, ignored=ignored)
    return (yield from within("Finding the markers", check, 0.7, 1.0))


def write_readouts(
    take: bpy.types.PropertyGroup, styles: "tuple[MarkerStyle, ...]", check: "MarkerCheck"
) -> list[str]:
    """Store a check with the markers, and its colors for previews; return all warnings."""
    update_clip_digest(take)
    readouts = {readout.name: readout for readout in check.readouts}
    for marker in take.markers:
        readout = readouts.get(marker.name)
        if readout is None:
            marker.sampled = 0
            continue
        marker.sampled, marker.found = readout.sampled, readout.found
        marker.area, marker.area_share = readout.area_px, readout.area_share
        marker.distinctness = readout.distinctness
        marker.warning = "\n".join(capitalized(sentence) for sentence in readout.warnings)
        marker.still_areas.clear()
        for box in readout.still_boxes:
            marker.still_areas.add().box = box
        marker.checked_clip = take.clip_state.contents
    keep_preview(take, styles, check)
    return [capitalized(sentence) for readout in check.readouts for sentence in readout.warnings]


@dataclass(frozen=True, eq=False)
class MarkerSearch:
    """What a job was told of a take's markers, and what it found of them."""

    take: str  # The take's identifier
    colors: dict[str, Rgb]  # New colors, by the markers' names
    more: "tuple[IgnoredRegion, ...]"  # Regions to be ignored from now on
    styles: "tuple[MarkerStyle, ...]"
    ignored: "tuple[IgnoredRegion, ...]"  # What was ignored before
    check: "MarkerCheck | None"  # None where no marker has a color


def search_markers(
    scene: bpy.types.Scene, colors: Mapping[str, Rgb] | None = None, more: "tuple[IgnoredRegion, ...]" = ()
) -> "Job[MarkerSearch]":
    """Look for the active take's markers with new colors, or without more regions of the picture."""
    take, new = active_take(scene), dict(colors or {})
    source, identifier, ignored = footage_of(scene, take), take.identifier, ignored_regions(take)
    styles = styles_with_colors(take, new)
    check = (yield from find_markers(source, styles, (*ignored, *more))) if styles else None
    return MarkerSearch(identifier, new, more, styles, ignored, check)


def write_search(scene: bpy.types.Scene, found: MarkerSearch, masks: bool = False) -> list[str]:
    """Store colors, regions and what was found of the markers, with their masks shown; return all warnings.

    Raises:
        InputError: The markers, or what is ignored, were changed while the job ran.
    """
    take = take_by_identifier(scene, found.take)
    if (styles_with_colors(take, found.colors), ignored_regions(take)) != (found.styles, found.ignored):
        raise InputError("the markers were changed while they were looked for; nothing was stored, try again")
    if found.colors and not len(take.markers):
        append_usual_markers(take)
    for marker in take.markers:
        if marker.name in found.colors:
            set_marker_color(marker, found.colors[marker.name])
    add_ignored_regions(take, found.more)
    warnings = [] if found.check is None else write_readouts(take, found.styles, found.check)
    if masks:
        show_masks(bpy.context, True)
    update_shown_masks(scene)
    redraw_footage(bpy.context)
    return warnings
