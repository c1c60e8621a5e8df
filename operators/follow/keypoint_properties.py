"""Properties of what a take follows: which kinds are switched on, and its sources of keypoints."""

import bpy
from bpy.types import Context, PropertyGroup

from ..shell.fields import HIDDEN, RELATIVE_PATH, Choice, Entries, Integer, Switch, Text, Vector
from ..shell.takes import redraw_footage
from .tracks import body_point_items


def _changed(_group: PropertyGroup, context: Context) -> None:
    redraw_footage(context)  # where the keypoints are drawn


class KEYMARK_PG_keypoint_file(bpy.types.PropertyGroup):
    """A file of keypoints, or a folder with a file a frame."""

    filepath: Text(
        "File",
        "The file of keypoints, or the folder with a file a frame",
        subtype="FILE_PATH",
        options=RELATIVE_PATH,
    )
    absolute_path: Text(
        "Absolute Path", "The same from the root, for a .blend that is saved elsewhere", options=HIDDEN
    )
    is_used: Switch("Use", "Hold the motion against these keypoints", default=True, update=_changed)
    contents: Text("Contents", "Digest of the file when it was loaded", options=HIDDEN)


class KEYMARK_PG_track_choice(bpy.types.PropertyGroup):
    """What a person chose a motion track of the clip to follow, whatever its name."""

    owner: Text("Object", "Name of the tracking object that the track belongs to")
    track: Text("Track", "Name of the motion track")
    point: Text("Body Point", "The body point that it follows; empty for none")


class KEYMARK_PG_clicked_point(bpy.types.PropertyGroup):
    """A body point that was clicked on in one frame."""

    point: Text("Body Point", "The point of the body")
    frame: Integer("Frame", "Frames after the clip's first one")
    pixel: Vector("Pixel", "Where, in pixels of the footage from its top left corner", size=2)


class KEYMARK_PG_follow(bpy.types.PropertyGroup):
    """What a take follows in the footage."""

    use_markers: Switch(
        "Follow Markers",
        "Hold the motion against the colored markers of the list",
        default=True,
        update=_changed,
    )
    use_keypoints: Switch(
        "Follow Keypoints",
        "Hold the motion against points of the body that a detector found or you clicked on",
        default=True,
        update=_changed,
    )
    use_depth_hints: Switch(
        "Depth Hints",
        "Take a detector's guess of depths as a hint, where its file has one; "
        "it is calibrated at your keyframes and never believed over them",
        default=True,
    )
    use_hands: Switch(
        "Hands",
        "Look at hands where they are large enough, so that palms face where they are seen to; what you pose "
        "stays as it is",
        default=True,
    )
    use_tracks: Switch(
        "Follow Tracks",
        "Hold the motion against the clip's own motion tracks that follow points of the body",
        default=True,
        update=_changed,
    )
    use_contours: Switch(
        "Follow Contours",
        "Hold the motion against the outline of the body, where the camera stands still",
        default=True,
    )
    reference: Text(
        "Reference Motion",
        "A 3D motion of the same performance from elsewhere, as a neural network's: it is "
        "turned, placed and mended as the footage shows, and needs no keyframes",
        subtype="FILE_PATH",
        options=RELATIVE_PATH,
    )
    files: Entries(type=KEYMARK_PG_keypoint_file)
    active_file: Integer("Active File", "The file of keypoints that is chosen in the list", default=0, min=0)
    tracks: Entries(type=KEYMARK_PG_track_choice)
    active_track: Integer("Active Track", "The track that is chosen in the list", default=0, min=0)
    clicks: Entries(type=KEYMARK_PG_clicked_point)
    active_click: Integer("Active Click", "The clicked point that is chosen in the list", default=0, min=0)
    clicked_point: Choice(
        "Body Point",
        "The point of the body to click on next; left and right are the performer's own",
        items=body_point_items(),
        default="wrist.L",
    )
