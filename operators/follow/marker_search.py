"""A take's markers and what is never one: lists, styles, and the search for them in the footage."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import bpy
from bpy.types import Context, Operator, PropertyGroup, Scene

from ...core.errors import InputError, pluralize
from ...core.markers.ignored_regions import IgnoredRegion
from ...core.markers.region_tracks import MarkerStyle
from ...core.progress import Job, within
from ..bridge.footage import Footage
from ..footage.load_footage import update_clip_digest
from ..shell import need, takes
from ..shell.base_operator import BaseOperator, Unchanged, call, capitalized, operator, remove_active, warn
from ..shell.footage_view import clip_index
from ..shell.job_operator import JobOperator
from ..shell.results import reading_of
from ..shell.takes import active_take, ensure_take, footage_of, redraw_footage, take_by_identifier
from .mask_previews import keep_preview, preview_of, show_masks, update_masks
from .properties import SEGMENTS, add_ignored_regions, clear_readouts, ignored_regions

if TYPE_CHECKING:
    from ...core.markers.marker_check import MarkerCheck
    from ...core.video.clip import ClipSamples

Rgb = tuple[int, int, int]  # Red, green, blue in 0 to 255

USUAL_SEGMENTS = ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
"""The five segments whose markers help most, in the order in which they are offered."""


def append_marker(take: PropertyGroup, segment: str) -> None:
    """Add a marker with a unique name after its segment, and make it the active one."""
    name = takes.unique_name(segment, [marker.name for marker in take.markers])
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


def marker_styles(take: PropertyGroup) -> tuple[MarkerStyle, ...]:
    """The styles of a take's markers; refused where two have one name or one segment."""
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


def styles_with_colors(take: PropertyGroup, colors: Mapping[str, Rgb]) -> tuple[MarkerStyle, ...]:
    """The styles of markers with a color, once some get new ones by name; of the usual five if none."""
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


_samples: "dict[str, ClipSamples]" = {}
"""Sampled frames of the last two clips, some megabytes each, by the digest of the file: the latest last."""


def find_markers(
    footage: Footage, styles: tuple[MarkerStyle, ...], ignored: tuple[IgnoredRegion, ...]
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


def _write_readouts(take: PropertyGroup, check: "MarkerCheck") -> None:
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


@dataclass(frozen=True, eq=False)
class MarkerSearch:
    """What a search starts from, and what it found of the markers."""

    take: str  # The take's identifier
    colors: dict[str, Rgb]  # New colors, by the markers' names
    more: tuple[IgnoredRegion, ...]  # Regions to be ignored from now on
    styles: tuple[MarkerStyle, ...]
    ignored: tuple[IgnoredRegion, ...]  # What was ignored before
    check: "MarkerCheck | None"  # None where no marker has a color


def search_markers(
    scene: Scene, colors: Mapping[str, Rgb] | None = None, more: tuple[IgnoredRegion, ...] = ()
) -> Job[MarkerSearch]:
    """Look for the active take's markers with new colors, or without more regions of the picture."""
    take, new = active_take(scene), dict(colors or {})
    source, identifier, ignored = footage_of(scene, take), take.identifier, ignored_regions(take)
    styles = styles_with_colors(take, new)
    check = (yield from find_markers(source, styles, (*ignored, *more))) if styles else None
    return MarkerSearch(identifier, new, more, styles, ignored, check)


def write_search(scene: Scene, found: MarkerSearch, masks: bool = False) -> list[str]:
    """Store colors, regions and what was found of the markers, and show their masks; return all warnings."""
    take, context = take_by_identifier(scene, found.take), bpy.context
    if (styles_with_colors(take, found.colors), ignored_regions(take)) != (found.styles, found.ignored):
        raise InputError("the markers were changed while they were looked for; nothing was stored, try again")
    if found.colors and not len(take.markers):
        append_usual_markers(take)
    for marker in take.markers:
        if marker.name in found.colors:
            set_marker_color(marker, found.colors[marker.name])
    add_ignored_regions(take, found.more)
    warnings: list[str] = []
    if found.check is not None:
        warnings = [sentence for readout in found.check.readouts for sentence in readout.warnings]
        _write_readouts(take, found.check)
        keep_preview(take, found.styles, found.check)
    if masks:
        show_masks(context, True)
    if context.window_manager.keymark_show_masks:
        update_masks(scene)
    redraw_footage(context)
    return warnings


def write_and_warn(operator: Any, scene: Scene, found: MarkerSearch, masks: bool = False) -> list[str]:
    """The same, with every warning reported."""
    return [warn(operator, sentence) for sentence in write_search(scene, found, masks)]


class KEYMARK_OT_check_markers(JobOperator, bpy.types.Operator):
    """Look for the markers in frames all over the clip: how large, distinct and reliably found each one is"""

    bl_label = "Check Markers"
    requirements = (need.footage, need.markers, need.picked_color, need.idle)

    def start(self, scene: Scene) -> Job[MarkerSearch]:
        return search_markers(scene)

    def finish(self, scene: Scene, result: MarkerSearch) -> None:
        if not write_and_warn(self, scene, result):
            self.report({"INFO"}, f"All {len(result.styles)} markers with a color are found well")


def still_boxes(take: PropertyGroup) -> tuple[Any, ...]:
    """Boxes of the still areas that the markers' readouts name, each once."""
    found = [marker for marker in take.markers if marker.has_readout(take)]
    return tuple(dict.fromkeys(tuple(area.box) for marker in found for area in marker.still_areas))


still_areas = need.of_take(
    lambda state: still_boxes(state.take),
    "Check the markers first; no still area of a marker's color is known",
)


class KEYMARK_OT_ignore_still_areas(JobOperator, bpy.types.Operator):
    """Leave out what keeps a marker's color in the same pixels while the marker moves: it is surely none"""

    bl_label = "Ignore Still Areas"
    requirements = (need.footage, need.markers, still_areas, need.idle)

    def start(self, scene: Scene) -> Job[MarkerSearch]:
        boxes = still_boxes(active_take(scene))
        return search_markers(scene, more=tuple(IgnoredRegion(box=box) for box in boxes))

    def finish(self, scene: Scene, result: MarkerSearch) -> None:
        write_and_warn(self, scene, result)
        self.report({"INFO"}, f"Still areas are never a marker: {len(result.more)} more")


@operator("Add Marker")
def add_marker(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Add a marker on the next body part that usually wears one"""
    take = ensure_take(context.scene)
    marked = {marker.segment for marker in take.markers}
    free = [segment for segment in (*USUAL_SEGMENTS, *SEGMENTS) if segment not in marked]
    if not free:
        raise InputError("every body part has a marker already")
    append_marker(take, free[0])


@operator("Add Usual Five")
def add_usual_markers(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Add the five markers that help most: trunk, both forearms and both shins"""
    take = ensure_take(context.scene)
    if {marker.segment for marker in take.markers}.issuperset(USUAL_SEGMENTS):
        raise Unchanged("trunk, forearms and shins have markers already")
    append_usual_markers(take)


@operator("Remove Marker", need.markers)
def remove_marker(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Remove the active marker"""
    if take.markers[min(take.active_marker, len(take.markers) - 1)].is_picked:
        clear_readouts(take)
    remove_active(take, "markers", "active_marker")


some_ignored = need.of_take(
    lambda state: len(state.take.ignored_regions), "No region of the picture is left out"
)


@operator("Remove Region", some_ignored, need.idle)
def remove_ignored_region(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Search the chosen region of the picture for markers again"""
    remove_active(take, "ignored_regions", "active_ignored")
    clear_readouts(take)
    redraw_footage(context)


class KEYMARK_OT_show_masks(BaseOperator, bpy.types.Operator):
    """Highlight the markers' colors over the footage, in the camera view and the Movie Clip editor"""

    bl_label = "Show Masks"
    bl_options = {"REGISTER"}
    requirements = (need.footage, need.markers, need.picked_color, need.idle)

    def run(self, context: Context) -> None:
        manager = context.window_manager
        if not manager.keymark_show_masks:
            if preview_of(active_take(context.scene)) is None:
                call(bpy.ops.keymark.check_markers, "INVOKE_DEFAULT")
            update_masks(context.scene)
        manager.keymark_show_masks = not manager.keymark_show_masks
        redraw_footage(context)
