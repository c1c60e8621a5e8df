"""A coloured marker as the scene stores it."""

import bpy

from ....core.body.human import HUMAN

WHOLE_TRUNK = "trunk"
WITHOUT_VOLUME = "girdle"
SEGMENTS = (
    WHOLE_TRUNK,
    *(segment.name for segment in HUMAN.segments if not segment.name.startswith(WITHOUT_VOLUME)),
)
"""What a marker can be bound to."""

UNPICKED = (0.5, 0.5, 0.5)
"""The color of a marker that has not been given one."""


def _title(segment: str) -> str:
    part, _, side = segment.partition(".")
    return part.replace("_", " ").title() + {"L": " Left", "R": " Right", "": ""}[side]


class KEYMARK_PG_marker(bpy.types.PropertyGroup):
    """One coloured marker."""

    name: bpy.props.StringProperty(name="Name", description="The marker's name")
    segment: bpy.props.EnumProperty(
        name="Segment",
        description="The body part that wears the marker; left and right are the performer's own",
        items=[(segment, _title(segment), "") for segment in SEGMENTS],
    )
    color: bpy.props.FloatVectorProperty(
        name="Color",
        description="The marker's color in the footage; one sample is enough",
        subtype="COLOR_GAMMA",
        size=3,
        min=0.0,
        max=1.0,
        default=UNPICKED,
    )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PG_marker,))
