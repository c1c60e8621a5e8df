"""Properties of the overlay of Timeline and Dope Sheet."""

import bpy

from ..shell.redraw import redraw_editors


def _changed(_settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    redraw_editors(context, "DOPESHEET_EDITOR")


class KEYMARK_PG_timeline(bpy.types.PropertyGroup):
    """Properties of the overlay of Timeline and Dope Sheet."""

    show_speed: bpy.props.BoolProperty(
        name="Speed",
        description="Graph of the speeds of what is followed; good keyframes lie where it is low",
        default=True,
        update=_changed,
    )
    show_proposals: bpy.props.BoolProperty(
        name="Proposed Keyframes",
        description="Diamonds at the proposed keyframes: hollow until the actor is posed there, then filled",
        default=True,
        update=_changed,
    )
    show_matches: bpy.props.BoolProperty(
        name="Found Keyframes",
        description="Squares at the keyframes that were found and not posed: hollow where in doubt",
        default=True,
        update=_changed,
    )
    show_confidence: bpy.props.BoolProperty(
        name="Confidence",
        description="A strip that is the higher and the bluer, the higher the confidence of a frame",
        default=True,
        update=_changed,
    )
    show_weak_frames: bpy.props.BoolProperty(
        name="Weak Frames",
        description="Triangles at the frames that are worth another keyframe",
        default=True,
        update=_changed,
    )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PG_timeline,))
