"""A colored marker as the scene stores it."""

import bpy

from ...core.body.human import HUMAN

WHOLE_TRUNK = "trunk"
WITHOUT_VOLUME = "girdle"
SEGMENTS = (
    WHOLE_TRUNK,
    *(segment.name for segment in HUMAN.segments if not segment.name.startswith(WITHOUT_VOLUME)),
)
"""What a marker can be bound to."""


def segment_title(segment: str) -> str:
    """What people call a segment."""
    part, _, side = segment.partition(".")
    return part.replace("_", " ").title() + {"L": " Left", "R": " Right", "": ""}[side]


def _take_of(marker: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    """The take that a marker belongs to."""
    takes = marker.id_data.keymark.takes
    return next((take for take in takes if any(other == marker for other in take.markers)), None)


def clear_readouts(take: bpy.types.PropertyGroup) -> None:
    """Forget what was found of a take's markers: each one's readout depends on all of them."""
    for marker in take.markers:
        marker.sampled = 0


def _changed(marker: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    take = _take_of(marker)
    if take is not None and marker.is_picked:
        clear_readouts(take)


def _segment_changed(marker: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    if marker.name == marker.named_after:
        marker.name = marker.named_after = marker.segment


class KEYMARK_PG_marker(bpy.types.PropertyGroup):
    """One colored marker, and what a look at the footage found of it."""

    name: bpy.props.StringProperty(name="Name", description="The marker's name", update=_changed)
    segment: bpy.props.EnumProperty(
        name="Segment",
        description="The body part that wears the marker; left and right are the performer's own",
        items=[(segment, segment_title(segment), "") for segment in SEGMENTS],
        update=_segment_changed,
    )
    color: bpy.props.FloatVectorProperty(
        name="Color",
        description="The marker's color in the footage; one sample is enough",
        subtype="COLOR_GAMMA",
        size=3,
        min=0.0,
        max=1.0,
        default=(0.5, 0.5, 0.5),
        update=_changed,
    )
    named_after: bpy.props.StringProperty(
        name="Named After",
        description="The segment that the name was taken from; the name follows it until you change it",
        options={"HIDDEN"},
    )
    sampled: bpy.props.IntProperty(
        name="Frames Looked At", description="Frames in which the marker was looked for; 0 for none yet"
    )
    found: bpy.props.IntProperty(
        name="Found In", description="Frames, of those looked at, in which the marker was found"
    )
    area: bpy.props.FloatProperty(
        name="Area", description="What the marker usually covers, in pixels of the footage"
    )
    area_share: bpy.props.FloatProperty(
        name="Share of the Picture", description="What the marker usually covers, as a share of the picture"
    )
    distinctness: bpy.props.FloatProperty(
        name="Distinctness",
        description="How surely its color tells the marker from everything else in the footage, 0 to 1",
    )
    warning: bpy.props.StringProperty(
        name="Warning", description="What may go wrong with the marker, one sentence a line"
    )
    checked_clip: bpy.props.StringProperty(
        name="Checked Clip",
        description="What the clip in which the marker was looked for is known by",
        options={"HIDDEN"},
    )

    @property
    def is_picked(self) -> bool:
        """Whether the marker was ever given a color."""
        return bool(self.is_property_set("color"))

    def has_readout(self, take: bpy.types.PropertyGroup) -> bool:
        """Whether what was found holds for the footage of the take it belongs to."""
        contents = take.clip_state.contents
        return bool(self.sampled and take.clip is not None and self.checked_clip == contents)


def register() -> None:
    """Register the marker, and the switch for masks, which no file keeps."""
    bpy.utils.register_class(KEYMARK_PG_marker)
    bpy.types.WindowManager.keymark_show_masks = bpy.props.BoolProperty(
        name="Show Masks", description="Draw over the footage what has the markers' colors", default=False
    )


def unregister() -> None:
    """Take both away."""
    del bpy.types.WindowManager.keymark_show_masks
    bpy.utils.unregister_class(KEYMARK_PG_marker)
