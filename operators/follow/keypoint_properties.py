"""Properties of what a take follows: which kinds are switched on, and its sources of keypoints."""

import bpy

from ..shell.takes import redraw_footage
from .tracks import body_point_items


def _changed(_group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    redraw_footage(context)  # where the keypoints are drawn


class KEYMARK_PG_keypoint_file(bpy.types.PropertyGroup):
    """A file of keypoints, or a folder with a file a frame."""

    filepath: bpy.props.StringProperty(
        name="File",
        description="The file of keypoints, or the folder with a file a frame",
        subtype="FILE_PATH",
        options={"ANIMATABLE", "PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    absolute_path: bpy.props.StringProperty(
        name="Absolute Path",
        description="The same from the root, for a .blend that is saved elsewhere",
        options={"HIDDEN"},
    )
    is_used: bpy.props.BoolProperty(
        name="Use", description="Hold the motion against these keypoints", default=True, update=_changed
    )
    contents: bpy.props.StringProperty(
        name="Contents", description="Digest of the file when it was loaded", options={"HIDDEN"}
    )


class KEYMARK_PG_track_choice(bpy.types.PropertyGroup):
    """What a person chose a motion track of the clip to follow, whatever its name."""

    owner: bpy.props.StringProperty(
        name="Object", description="Name of the tracking object that the track belongs to"
    )
    track: bpy.props.StringProperty(name="Track", description="Name of the motion track")
    point: bpy.props.StringProperty(
        name="Body Point", description="The body point that it follows; empty for none"
    )


class KEYMARK_PG_clicked_point(bpy.types.PropertyGroup):
    """A body point that was clicked on in one frame."""

    point: bpy.props.StringProperty(name="Body Point", description="The point of the body")
    frame: bpy.props.IntProperty(name="Frame", description="Frames after the clip's first one")
    pixel: bpy.props.FloatVectorProperty(
        name="Pixel", description="Where, in pixels of the footage from its top left corner", size=2
    )


class KEYMARK_PG_follow(bpy.types.PropertyGroup):
    """What a take follows in the footage."""

    use_markers: bpy.props.BoolProperty(
        name="Follow Markers",
        description="Hold the motion against the colored markers of the list",
        default=True,
        update=_changed,
    )
    use_keypoints: bpy.props.BoolProperty(
        name="Follow Keypoints",
        description="Hold the motion against points of the body that a detector found or you clicked on",
        default=True,
        update=_changed,
    )
    use_depth_hints: bpy.props.BoolProperty(
        name="Depth Hints",
        description="Take a detector's guess of depths as a hint, where its file has one; "
        "it is calibrated at your keyframes and never believed over them",
        default=True,
    )
    use_tracks: bpy.props.BoolProperty(
        name="Follow Tracks",
        description="Hold the motion against the clip's own motion tracks that follow points of the body",
        default=True,
        update=_changed,
    )
    use_contours: bpy.props.BoolProperty(
        name="Follow Contours",
        description="Hold the motion against the outline of the body, where the camera stands still",
        default=True,
    )
    reference: bpy.props.StringProperty(
        name="Reference Motion",
        description="A 3D motion of the same performance from elsewhere, as a neural network's: it is "
        "turned, placed and mended as the footage shows, and needs no keyframes",
        subtype="FILE_PATH",
        options={"ANIMATABLE", "PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    files: bpy.props.CollectionProperty(type=KEYMARK_PG_keypoint_file)
    active_file: bpy.props.IntProperty(
        name="Active File", description="The file of keypoints that is chosen in the list", default=0, min=0
    )
    tracks: bpy.props.CollectionProperty(type=KEYMARK_PG_track_choice)
    active_track: bpy.props.IntProperty(
        name="Active Track", description="The track that is chosen in the list", default=0, min=0
    )
    clicks: bpy.props.CollectionProperty(type=KEYMARK_PG_clicked_point)
    active_click: bpy.props.IntProperty(
        name="Active Click", description="The clicked point that is chosen in the list", default=0, min=0
    )
    clicked_point: bpy.props.EnumProperty(
        name="Body Point",
        description="The point of the body to click on next; left and right are the performer's own",
        items=body_point_items(),
        default="wrist.L",
    )


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_PG_keypoint_file, KEYMARK_PG_track_choice, KEYMARK_PG_clicked_point, KEYMARK_PG_follow)
)
