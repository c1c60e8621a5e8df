"""State of a take's clip at the last check of its file, cached for panels."""

import bpy


class KEYMARK_PG_clip_state(bpy.types.PropertyGroup):
    """State of a take's clip at the last check of its file."""

    missing: bpy.props.BoolProperty(
        name="Missing", description="The clip's file was not found", options={"HIDDEN"}
    )
    contents: bpy.props.StringProperty(
        name="Contents", description="Digest of the clip's file", options={"HIDDEN"}
    )
    rate: bpy.props.FloatProperty(
        name="Rate",
        description="Frames per second of the clip on the timeline",
        min=0.0,
        options={"HIDDEN"},
    )
    variable_rate: bpy.props.BoolProperty(
        name="Variable Rate",
        description="The clip's frames are unevenly spaced in time",
        options={"HIDDEN"},
    )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PG_clip_state,))
