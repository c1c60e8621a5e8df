"""Properties of a colored marker, and the switch that shows masks."""

import bpy

from ...core.body.human import HUMAN
from .ignored_properties import KEYMARK_PG_ignored_region

WHOLE_TRUNK = "trunk"
WITHOUT_VOLUME = "girdle"
SEGMENTS = (
    WHOLE_TRUNK,
    *(segment.name for segment in HUMAN.segments if not segment.name.startswith(WITHOUT_VOLUME)),
)
"""Segments that a marker can be bound to."""


def segment_title(segment: str) -> str:
    """Return a segment's label."""
    part, _, side = segment.partition(".")
    return part.replace("_", " ").title() + {"L": " Left", "R": " Right", "": ""}[side]


def _take_of(marker: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    """Return the take that a marker belongs to."""
    takes = marker.id_data.keymark.takes
    return next((take for take in takes if any(other == marker for other in take.markers)), None)


def clear_readouts(take: bpy.types.PropertyGroup) -> None:
    """Clear the readouts of a take's markers: each depends on all markers."""
    for marker in take.markers:
        marker.sampled = 0


def _on_changed(marker: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    take = _take_of(marker)
    if take is not None and marker.is_picked:
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
        name="Share of the Picture",
        description="Share of the picture that the marker usually covers",
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
        """Whether the marker has a color."""
        return bool(self.is_property_set("color"))

    def has_readout(self, take: bpy.types.PropertyGroup) -> bool:
        """Whether the readout is of the footage of the take that the marker belongs to."""
        contents = take.clip_state.contents
        return bool(self.sampled and take.clip is not None and self.checked_clip == contents)


def register() -> None:
    """Register the marker, and the switch for masks, which no file keeps."""
    bpy.utils.register_class(KEYMARK_PG_marker)
    bpy.types.WindowManager.keymark_show_masks = bpy.props.BoolProperty(
        name="Show Masks", description="Highlight the markers' colors over the footage", default=False
    )


def unregister() -> None:
    """Remove both."""
    del bpy.types.WindowManager.keymark_show_masks
    bpy.utils.unregister_class(KEYMARK_PG_marker)
