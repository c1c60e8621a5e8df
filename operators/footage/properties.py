"""Properties of a take's footage: the state of its clip for panels, and lines drawn to find its camera."""

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


KINDS = (
    ("VERTICAL", "Vertical", "Plumb in the world: door frames, corners of walls"),
    ("LEVEL", "Level", "Level and parallel to each other in the world: on the floor, or along a wall"),
    ("ACROSS", "Across", "Level, and at right angles to the lines that are called level"),
    ("HEIGHT", "Known Height", "From the floor up to a known height: the performer, or a door"),
)
"""Kinds of lines that are drawn over the footage."""


class KEYMARK_PG_camera_line(bpy.types.PropertyGroup):
    """A line that was drawn over the footage to find the camera."""

    kind: bpy.props.EnumProperty(name="Kind", description="What the line is in the world", items=KINDS)
    start: bpy.props.FloatVectorProperty(
        name="Start", description="In pixels of the footage from its top left corner", size=2
    )
    end: bpy.props.FloatVectorProperty(
        name="End", description="In pixels of the footage from its top left corner", size=2
    )
    length: bpy.props.FloatProperty(
        name="Length",
        description="Length of a line of known height; 0 for the performer's height",
        subtype="DISTANCE",
        min=0.0,
        soft_max=10.0,
    )
    frame: bpy.props.IntProperty(name="Frame", description="Scene frame in which it was drawn")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PG_clip_state, KEYMARK_PG_camera_line))
