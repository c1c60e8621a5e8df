"""Properties of colored markers, and of regions of the picture that are never a marker."""

import bpy

from ...core.body.human import HUMAN
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

    pixel: bpy.props.FloatVectorProperty(
        name="Pixel", description="Where, in pixels of the footage from its top left corner", size=2
    )


class KEYMARK_PG_ignored_region(bpy.types.PropertyGroup):
    """A region of the picture that is never a marker."""

    name: bpy.props.StringProperty(name="Name", description="Your name for this region")
    box: bpy.props.FloatVectorProperty(
        name="Box",
        description="Left, top, right and bottom of a box in pixels of the footage; unused by a stroke",
        size=4,
    )
    stroke: bpy.props.CollectionProperty(type=KEYMARK_PG_stroke_point)
    radius: bpy.props.FloatProperty(
        name="Radius", description="The brush's radius in pixels of the footage", min=0.0
    )
    some_frames: bpy.props.BoolProperty(
        name="Some Frames Only",
        description="Leave the region out in the frames from first to last, not in the whole clip",
        default=False,
        update=_changed,
    )
    first: bpy.props.IntProperty(
        name="First", description="Its first frame, counted from the clip's first", options={"HIDDEN"}
    )
    last: bpy.props.IntProperty(
        name="Last", description="Its last frame, counted from the clip's first", options={"HIDDEN"}
    )
    first_frame: bpy.props.IntProperty(
        name="First Frame",
        description="First frame of the scene in which the region is left out",
        get=_shown_first,
        set=_set_first,
    )
    last_frame: bpy.props.IntProperty(
        name="Last Frame",
        description="Last frame of the scene in which the region is left out",
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

    name: bpy.props.StringProperty(name="Name", description="The marker's name", update=_on_changed)
    segment: bpy.props.EnumProperty(
        name="Segment",
        description="The body part that wears the marker; left and right are the performer's own",
        items=[(segment, segment_title(segment), "") for segment in SEGMENTS],
        update=_on_segment_changed,
    )
    color: bpy.props.FloatVectorProperty(
        name="Color",
        description="The marker's color in the footage; one sample is enough",
        subtype="COLOR_GAMMA",
        size=3,
        min=0.0,
        max=1.0,
        default=(0.5, 0.5, 0.5),
        update=_on_changed,
    )
    named_after: bpy.props.StringProperty(
        name="Named After",
        description="The segment that the name was taken from; the name follows it until you change it",
        options={"HIDDEN"},
    )
    sampled: bpy.props.IntProperty(
        name="Sampled Frames", description="Frames in which the marker was looked for; 0 for none yet"
    )
    found: bpy.props.IntProperty(name="Found In", description="Sampled frames in which the marker was found")
    area: bpy.props.FloatProperty(
        name="Area", description="Area that the marker usually covers, in pixels of the footage"
    )
    area_share: bpy.props.FloatProperty(
        name="Share of the Picture", description="Share of the picture that the marker usually covers"
    )
    distinctness: bpy.props.FloatProperty(
        name="Distinctness",
        description="Certainty that its color belongs to the marker and nothing else in the footage, 0 to 1",
    )
    warning: bpy.props.StringProperty(
        name="Warning", description="Likely problems with the marker, one sentence a line"
    )
    still_areas: bpy.props.CollectionProperty(type=KEYMARK_PG_ignored_region)
    checked_clip: bpy.props.StringProperty(
        name="Checked Clip",
        description="Digest of the clip in which the marker was looked for",
        options={"HIDDEN"},
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
    bpy.types.WindowManager.keymark_show_masks = bpy.props.BoolProperty(
        name="Show Masks", description="Highlight the markers' colors over the footage", default=False
    )


def unregister() -> None:
    """Take it all back."""
    del bpy.types.WindowManager.keymark_show_masks
    _unregister_classes()
