"""Properties of colored markers, and of regions of the picture that are never a marker."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import bpy
from bpy.types import Context, PropertyGroup

from ...core.body.human import HUMAN
from ..shell.fields import HIDDEN, Choice, Entries, Integer, Number, Switch, Text, Vector
from ..shell.takes import footage_of, unique_name

if TYPE_CHECKING:
    from ...core.markers.ignored_regions import IgnoredRegion


def take_of(entry: PropertyGroup, entries: str) -> PropertyGroup | None:
    """The take in whose list of that name an entry is."""
    takes = entry.id_data.keymark.takes
    return next((take for take in takes if any(each == entry for each in getattr(take, entries))), None)


def clear_readouts(take: PropertyGroup | None) -> None:
    """Clear the readouts of a take's markers: each depends on all markers, and on what is ignored."""
    for marker in take.markers if take is not None else ():
        marker.sampled = 0


# --- Regions of the picture that are never a marker


def _changed(region: PropertyGroup, context: Context) -> None:
    clear_readouts(take_of(region, "ignored_regions"))


def _scene_frame(name: str, description: str, counted: str) -> Any:
    """A region's first or last frame, `counted` from the clip's first, as the scene's frame."""

    def clip_start(region: PropertyGroup) -> int:
        take = take_of(region, "ignored_regions")
        has_clip = take is not None and take.clip is not None
        return footage_of(region.id_data, take).first_frame if has_clip else 1

    def shown(region: PropertyGroup) -> int:
        return int(getattr(region, counted)) + clip_start(region)

    def choose(region: PropertyGroup, frame: int) -> None:
        chosen = max(frame - clip_start(region), 0)
        setattr(region, counted, chosen)
        if region.last < region.first:
            region.first = region.last = chosen
        _changed(region, bpy.context)

    return Integer(name, description, get=shown, set=choose)


class KEYMARK_PG_stroke_point(bpy.types.PropertyGroup):
    """A point of a brush's path."""

    pixel: Vector("Pixel", "Where, in pixels of the footage from its top left corner", size=2)


class KEYMARK_PG_ignored_region(bpy.types.PropertyGroup):
    """A region of the picture that is never a marker."""

    name: Text("Name", "Your name for this region")
    box: Vector(
        "Box", "Left, top, right and bottom of a box in pixels of the footage; unused by a stroke", size=4
    )
    stroke: Entries(type=KEYMARK_PG_stroke_point)
    radius: Number("Radius", "The brush's radius in pixels of the footage", min=0.0)
    some_frames: Switch(
        "Some Frames Only",
        "Leave the region out in the frames from first to last, not in the whole clip",
        default=False,
        update=_changed,
    )
    first: Integer("First", "Its first frame, counted from the clip's first", options=HIDDEN)
    last: Integer("Last", "Its last frame, counted from the clip's first", options=HIDDEN)
    first_frame: _scene_frame(
        "First Frame", "First frame of the scene in which the region is left out", "first"
    )
    last_frame: _scene_frame("Last Frame", "Last frame of the scene in which the region is left out", "last")


PLACES = 2  # Decimals of a pixel that files keep: Blender's own numbers are of single precision


def ignored_regions(take: PropertyGroup) -> "tuple[IgnoredRegion, ...]":
    """The regions of a take."""
    from ...core.markers.ignored_regions import IgnoredRegion

    def rounded(numbers: Iterable[float]) -> tuple[Any, ...]:
        return tuple(round(float(value), PLACES) for value in numbers)

    regions = []
    for region in take.ignored_regions:
        frames = (int(region.first), int(region.last)) if region.some_frames else None
        if len(region.stroke):
            stroke = tuple(rounded(point.pixel) for point in region.stroke)
            radius_px = round(float(region.radius), PLACES)
            regions.append(IgnoredRegion(stroke=stroke, radius_px=radius_px, frames=frames))
        else:
            regions.append(IgnoredRegion(box=rounded(region.box), frames=frames))
    return tuple(regions)


def add_ignored_regions(take: PropertyGroup, regions: "Iterable[IgnoredRegion]") -> None:
    """Add regions to a take; the last becomes the active one."""
    length = take.clip.frame_duration if take.clip is not None else 1
    for region in regions:
        name = "Brushed" if region.box is None else "Still Area"
        made = take.ignored_regions.add()
        made.name = unique_name(name, [each.name for each in take.ignored_regions if each != made])
        if region.box is not None:
            made.box = region.box
        for pixel in region.stroke:
            made.stroke.add().pixel = pixel
        made.radius = region.radius_px
        made.first, made.last = region.frames or (0, max(length - 1, 0))
        made.some_frames = region.frames is not None
        take.active_ignored = len(take.ignored_regions) - 1


# --- Markers


SEGMENTS = ("trunk", *(each.name for each in HUMAN.segments if not each.name.startswith("girdle")))
"""Segments that a marker can be bound to: the whole trunk, and all that have a volume."""


def segment_title(segment: str) -> str:
    """Return a segment's label."""
    part, _, side = segment.partition(".")
    return part.replace("_", " ").title() + {"L": " Left", "R": " Right", "": ""}[side]


def _on_changed(marker: PropertyGroup, context: Context) -> None:
    if marker.is_picked:
        clear_readouts(take_of(marker, "markers"))


def _on_segment_changed(marker: PropertyGroup, context: Context) -> None:
    if marker.name == marker.named_after:
        marker.name = marker.named_after = marker.segment


class KEYMARK_PG_marker(bpy.types.PropertyGroup):
    """A colored marker, and its readout from the footage."""

    name: Text("Name", "The marker's name", update=_on_changed)
    segment: Choice(
        "Segment",
        "The body part that wears the marker; left and right are the performer's own",
        items=[(segment, segment_title(segment), "") for segment in SEGMENTS],
        update=_on_segment_changed,
    )
    color: Vector(
        "Color",
        "The marker's color in the footage; one sample is enough",
        subtype="COLOR_GAMMA",
        size=3,
        min=0.0,
        max=1.0,
        default=(0.5, 0.5, 0.5),
        update=_on_changed,
    )
    named_after: Text(
        "Named After",
        "The segment that the name was taken from; the name follows it until you change it",
        options=HIDDEN,
    )
    sampled: Integer("Sampled Frames", "Frames in which the marker was looked for; 0 for none yet")
    found: Integer("Found In", "Sampled frames in which the marker was found")
    area: Number("Area", "Area that the marker usually covers, in pixels of the footage")
    area_share: Number("Share of the Picture", "Share of the picture that the marker usually covers")
    distinctness: Number(
        "Distinctness",
        "Certainty that its color belongs to the marker and nothing else in the footage, 0 to 1",
    )
    warning: Text("Warning", "Likely problems with the marker, one sentence a line")
    still_areas: Entries(type=KEYMARK_PG_ignored_region)
    checked_clip: Text(
        "Checked Clip", "Digest of the clip in which the marker was looked for", options=HIDDEN
    )

    @property
    def is_picked(self) -> bool:
        return bool(self.is_property_set("color"))

    def has_readout(self, take: PropertyGroup) -> bool:
        """Whether the readout is of the footage of the take that the marker belongs to."""
        contents = take.clip_state.contents
        return bool(self.sampled and take.clip is not None and self.checked_clip == contents)


ATTACHED = {
    "WindowManager.keymark_show_masks": Switch(
        "Show Masks", "Highlight the markers' colors over the footage", default=False
    )
}
"""No file keeps it."""
