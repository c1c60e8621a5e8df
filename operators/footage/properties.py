"""What was found of a take's clip when it was last looked at, so that panels need not look."""

import bpy


class KEYMARK_PG_clip_state(bpy.types.PropertyGroup):
    """What was found of a take's clip."""

    missing: bpy.props.BoolProperty(
        name="Missing", description="The clip's file was not found", options={"HIDDEN"}
    )
    contents: bpy.props.StringProperty(
        name="Contents", description="What the clip's file is known by again", options={"HIDDEN"}
    )
    rate: bpy.props.FloatProperty(
        name="Rate",
        description="Frames per second by which the clip lies on the time line",
        min=0.0,
        options={"HIDDEN"},
    )
    variable_rate: bpy.props.BoolProperty(
        name="Variable Rate",
        description="The clip's frames are unevenly spaced in time",
        options={"HIDDEN"},
    )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PG_clip_state,))
