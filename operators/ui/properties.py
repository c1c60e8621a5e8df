"""What Keymark stores in a scene: the actor, its Actions and its markers."""

import bpy

from ...core.body.human import HUMAN

WHOLE_TRUNK = "trunk"
WITHOUT_VOLUME = "girdle"
SEGMENTS = (
    WHOLE_TRUNK,
    *(segment.name for segment in HUMAN.segments if not segment.name.startswith(WITHOUT_VOLUME)),
)
"""What a marker can be bound to."""
METHODS = (
    ("map", "Whole Clip", "Estimate all frames at once; the most accurate"),
    ("ekf", "Fuzzy Kalman Filter", "The published filter, frame after frame; for comparison"),
    ("interpolation", "Keyframes Only", "Interpolate the keyframes without looking at the footage"),
)


def _title(segment: str) -> str:
    part, _, side = segment.partition(".")
    return part.replace("_", " ").title() + {"L": " Left", "R": " Right", "": ""}[side]


def _is_armature(_settings: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    return bool(candidate.type == "ARMATURE")


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
        default=(0.5, 0.5, 0.5),
    )


class KEYMARK_PG_settings(bpy.types.PropertyGroup):
    """Keymark's part of a scene."""

    armature: bpy.props.PointerProperty(
        name="Actor",
        description="The performer's armature",
        type=bpy.types.Object,
        poll=_is_armature,
    )
    stature: bpy.props.FloatProperty(
        name="Height",
        description="The performer's body height, from which an actor of average proportions is built",
        subtype="DISTANCE",
        precision=3,
        default=1.75,
        min=0.5,
        max=3.0,
    )
    keyframe_action: bpy.props.PointerProperty(
        name="Keyframes",
        description="The Action that holds the keyframes you pose",
        type=bpy.types.Action,
    )
    motion_action: bpy.props.PointerProperty(
        name="Motion",
        description="The Action that holds the reconstructed motion",
        type=bpy.types.Action,
    )
    method: bpy.props.EnumProperty(
        name="Method", description="How the frames between the keyframes are found", items=METHODS
    )
    keyframe_count: bpy.props.IntProperty(
        name="Count",
        description="How many keyframes to propose; 0 for 10 in 100 frames",
        default=0,
        min=0,
        soft_max=100,
    )
    markers: bpy.props.CollectionProperty(type=KEYMARK_PG_marker)
    active_marker: bpy.props.IntProperty(name="Active Marker", default=0, min=0)


class KEYMARK_PG_progress(bpy.types.PropertyGroup):
    """How far the running job is; shown only while one runs."""

    stage: bpy.props.StringProperty()
    fraction: bpy.props.FloatProperty(min=0.0, max=1.0)

    def show(self, stage: str, fraction: float) -> None:
        """Set both."""
        self.stage = stage
        self.fraction = fraction


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (KEYMARK_PG_marker, KEYMARK_PG_settings, KEYMARK_PG_progress)
)


def register() -> None:
    """Add the properties to scenes and to the window manager."""
    _register_classes()
    bpy.types.Scene.keymark = bpy.props.PointerProperty(type=KEYMARK_PG_settings)
    bpy.types.WindowManager.keymark_progress = bpy.props.PointerProperty(type=KEYMARK_PG_progress)


def unregister() -> None:
    """Take them away."""
    del bpy.types.WindowManager.keymark_progress
    del bpy.types.Scene.keymark
    _unregister_classes()
