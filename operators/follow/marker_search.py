"""The lists of markers and of what is never one, and the search for the markers in the footage."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
from bpy.types import Context, PropertyGroup, Scene

from ...core.errors import InputError
from ...core.progress import within
from ..bridge.footage import Footage
from ..footage.take_footage import update_clip_digest
from ..shell.base_operator import BaseOperator, Unchanged, call, capitalized, remove_active, warn
from ..shell.job_operator import JobOperator
from ..shell.requirements import footage, idle, markers, of_take, picked_color
from ..shell.takes import active_take, ensure_take, footage_of, redraw_footage, take_by_identifier
from .marker_properties import SEGMENTS, add_ignored_regions, clear_readouts, ignored_regions
from .marker_styles import (
    USUAL_SEGMENTS,
    Rgb,
    append_marker,
    append_usual_markers,
    set_marker_color,
    styles_with_colors,
)
from .mask_previews import keep_preview, preview_of, show_masks, update_masks

if TYPE_CHECKING:
    from ...core.markers.ignored_regions import IgnoredRegion
    from ...core.markers.marker_check import MarkerCheck
    from ...core.markers.region_tracks import MarkerStyle
    from ...core.progress import Job
    from ...core.video.clip import ClipSamples


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


def _write_readouts(
    take: PropertyGroup, styles: "tuple[MarkerStyle, ...]", check: "MarkerCheck"
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
    return [sentence for readout in check.readouts for sentence in readout.warnings]


@dataclass(frozen=True, eq=False)
class MarkerSearch:
    """What a search starts from, and what it found of the markers."""

    take: str  # The take's identifier
    colors: dict[str, Rgb]  # New colors, by the markers' names
    more: "tuple[IgnoredRegion, ...]"  # Regions to be ignored from now on
    styles: "tuple[MarkerStyle, ...]"
    ignored: "tuple[IgnoredRegion, ...]"  # What was ignored before
    check: "MarkerCheck | None"  # None where no marker has a color


def search_markers(
    scene: Scene, colors: Mapping[str, Rgb] | None = None, more: "tuple[IgnoredRegion, ...]" = ()
) -> "Job[MarkerSearch]":
    """Look for the active take's markers with new colors, or without more regions of the picture."""
    take, new = active_take(scene), dict(colors or {})
    source, identifier, ignored = footage_of(scene, take), take.identifier, ignored_regions(take)
    styles = styles_with_colors(take, new)
    check = (yield from find_markers(source, styles, (*ignored, *more))) if styles else None
    return MarkerSearch(identifier, new, more, styles, ignored, check)


def write_search(scene: Scene, found: MarkerSearch, masks: bool = False) -> list[str]:
    """Store colors, regions and what was found of the markers, with their masks shown; return all warnings.

    Raises:
        InputError: The markers, or what is ignored, were changed while the job ran.
    """
    take, context = take_by_identifier(scene, found.take), bpy.context
    if (styles_with_colors(take, found.colors), ignored_regions(take)) != (found.styles, found.ignored):
        raise InputError("the markers were changed while they were looked for; nothing was stored, try again")
    if found.colors and not len(take.markers):
        append_usual_markers(take)
    for marker in take.markers:
        if marker.name in found.colors:
            set_marker_color(marker, found.colors[marker.name])
    add_ignored_regions(take, found.more)
    warnings = [] if found.check is None else _write_readouts(take, found.styles, found.check)
    if masks:
        show_masks(context, True)
    if context.window_manager.keymark_show_masks:
        update_masks(scene)
    redraw_footage(context)
    return warnings


def write_and_warn(
    operator: bpy.types.Operator, scene: Scene, found: MarkerSearch, masks: bool = False
) -> list[str]:
    """The same, with every warning reported."""
    return [warn(operator, sentence) for sentence in write_search(scene, found, masks)]


class KEYMARK_OT_check_markers(JobOperator, bpy.types.Operator):
    """Look for the markers in frames all over the clip: how large, distinct and reliably found each one is"""

    bl_label = "Check Markers"
    requirements = (footage, markers, picked_color, idle)

    def start(self, scene: Scene) -> "Job[MarkerSearch]":
        return search_markers(scene)

    def finish(self, scene: Scene, result: MarkerSearch) -> None:
        if not write_and_warn(self, scene, result):
            self.report({"INFO"}, f"All {len(result.styles)} markers with a color are found well")


def has_still_areas(take: PropertyGroup) -> bool:
    """Whether the markers' readouts name any still area."""
    return any(marker.has_readout(take) and len(marker.still_areas) for marker in take.markers)


still_areas = of_take(
    lambda state: has_still_areas(state.take),
    "Check the markers first; no still area of a marker's color is known",
)


class KEYMARK_OT_ignore_still_areas(JobOperator, bpy.types.Operator):
    """Leave out what keeps a marker's color in the same pixels while the marker moves: it is surely none"""

    bl_label = "Ignore Still Areas"
    requirements = (footage, markers, still_areas, idle)

    def start(self, scene: Scene) -> "Job[MarkerSearch]":
        from ...core.markers.ignored_regions import IgnoredRegion

        take = active_take(scene)
        found = [marker for marker in take.markers if marker.has_readout(take)]
        boxes = dict.fromkeys(tuple(area.box) for marker in found for area in marker.still_areas)
        return search_markers(scene, more=tuple(IgnoredRegion(box=box) for box in boxes))

    def finish(self, scene: Scene, result: MarkerSearch) -> None:
        write_and_warn(self, scene, result)
        self.report({"INFO"}, f"Still areas are never a marker: {len(result.more)} more")


class KEYMARK_OT_add_marker(BaseOperator, bpy.types.Operator):
    """Add a marker on the next body part that usually wears one"""

    bl_label = "Add Marker"

    def run(self, context: Context) -> None:
        take = ensure_take(context.scene)
        marked = {marker.segment for marker in take.markers}
        free = [segment for segment in (*USUAL_SEGMENTS, *SEGMENTS) if segment not in marked]
        if not free:
            raise InputError("every body part has a marker already")
        append_marker(take, free[0])


class KEYMARK_OT_add_usual_markers(BaseOperator, bpy.types.Operator):
    """Add the five markers that help most: trunk, both forearms and both shins"""

    bl_label = "Add Usual Five"

    def run(self, context: Context) -> None:
        take = ensure_take(context.scene)
        if {marker.segment for marker in take.markers}.issuperset(USUAL_SEGMENTS):
            raise Unchanged("trunk, forearms and shins have markers already")
        append_usual_markers(take)


class KEYMARK_OT_remove_marker(BaseOperator, bpy.types.Operator):
    """Remove the active marker"""

    bl_label = "Remove Marker"
    requirements = (markers,)

    def run(self, context: Context) -> None:
        take = active_take(context.scene)
        if take.markers[min(take.active_marker, len(take.markers) - 1)].is_picked:
            clear_readouts(take)
        remove_active(take, "markers", "active_marker")


some_ignored = of_take(lambda state: len(state.take.ignored_regions), "No region of the picture is left out")


class KEYMARK_OT_remove_ignored_region(BaseOperator, bpy.types.Operator):
    """Search the chosen region of the picture for markers again"""

    bl_label = "Remove Region"
    requirements = (some_ignored, idle)

    def run(self, context: Context) -> None:
        take = active_take(context.scene)
        remove_active(take, "ignored_regions", "active_ignored")
        clear_readouts(take)
        redraw_footage(context)


class KEYMARK_OT_show_masks(BaseOperator, bpy.types.Operator):
    """Highlight the markers' colors over the footage, in the camera view and the Movie Clip editor"""

    bl_label = "Show Masks"
    bl_options = {"REGISTER"}
    requirements = (footage, markers, picked_color, idle)

    def run(self, context: Context) -> None:
        manager = context.window_manager
        if not manager.keymark_show_masks:
            if preview_of(active_take(context.scene)) is None:
                call(bpy.ops.keymark.check_markers, "INVOKE_DEFAULT")
            update_masks(context.scene)
        manager.keymark_show_masks = not manager.keymark_show_masks
        redraw_footage(context)
