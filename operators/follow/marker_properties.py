"""Properties of colored markers, and of regions of the picture that are never a marker."""

import bpy

from ...core.body.human import HUMAN
from ..shell.fields import HIDDEN, Choice, Entries, Integer, Number, Switch, Text, Vector
from ..shell.takes import footage_of


def _changed(region: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """What was found of the markers depends on what is ignored."""
    for take in region.id_data.keymark.takes:
        if any(other == region for other in take.ignored_regions):
            clear_readouts(take)


def _clip_start(region: bpy.types.PropertyGroup) -> int:
    """Scene frame of the first frame of the clip of the region's take; 1 without a clip."""
    scene = region.id_data
    for take in scene.keymark.takes:
        if take.clip is not None and any(other == region for other in take.ignored_regions):
            return footage_of(scene, take).first_frame
    return 1


def _shown_first(region: bpy.types.PropertyGroup) -> int:
    return int(region.first) + _clip_start(region)


def _shown_last(region: bpy.types.PropertyGroup) -> int:
    return int(region.last) + _clip_start(region)


def _set_first(region: bpy.types.PropertyGroup, frame: int) -> None:
    region.first = max(frame - _clip_start(region), 0)
    region.last = max(region.last, region.first)
    _changed(region, bpy.context)


def _set_last(region: bpy.types.PropertyGroup, frame: int) -> None:
    region.last = max(frame - _clip_start(region), 0)
    region.first = min(region.first, region.last)
    _changed(region, bpy.context)


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
    first_frame: Integer(
        "First Frame",
        "First frame of the scene in which the region is left out",
        get=_shown_first,
        set=_set_first,
    )
    last_frame: Integer(
        "Last Frame",
        "Last frame of the scene in which the region is left out",
        get=_shown_last,
        set=_set_last,
    )


SEGMENTS = ("trunk", *(each.name for each in HUMAN.segments if not each.name.startswith("girdle")))
"""Segments that a marker can be bound to: the whole trunk, and all that have a volume."""


def segment_title(segment: str) -> str:
    """Return a segment's label."""
    part, _, side = segment.partition(".")
    return part.replace("_", " ").title() + {"L": " Left", "R": " Right", "": ""}[side]


def clear_readouts(take: bpy.types.PropertyGroup) -> None:
    """Clear the readouts of a take's markers: each depends on all markers."""
    for marker in take.markers:
        marker.sampled = 0


def _on_changed(marker: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    for take in marker.id_data.keymark.takes:
        if marker.is_picked and any(other == marker for other in take.markers):
            clear_readouts(take)


def _on_segment_changed(marker: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
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

    def has_readout(self, take: bpy.types.PropertyGroup) -> bool:
        """Whether the readout is of the footage of the take that the marker belongs to."""
        contents = take.clip_state.contents
        return bool(self.sampled and take.clip is not None and self.checked_clip == contents)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (KEYMARK_PG_stroke_point, KEYMARK_PG_ignored_region, KEYMARK_PG_marker)
)


def register() -> None:
    """Register the groups, and the switch for masks, which no file keeps."""
    _register_classes()
    bpy.types.WindowManager.keymark_show_masks = Switch(
        "Show Masks", "Highlight the markers' colors over the footage", default=False
    )


def unregister() -> None:
    """Take it all back."""
    del bpy.types.WindowManager.keymark_show_masks
    _unregister_classes()
