"""Properties of the review: confidence of a take's motion, and its weak frames."""

import bpy
from bpy.types import Context, PropertyGroup

from ..bridge.scene_frames import show_frame
from ..shell.fields import Choice, Entries, Integer, Number, Text

REASONS = (
    ("HIDDEN", "Hidden", "A marker or a body point is hidden around this frame", "HIDE_ON", 0),
    ("FAST", "Fast Motion", "The performer moves faster than usual around this frame", "FF", 1),
    ("FAR", "Keyframes Far", "The nearest keyframe is far", "ARROW_LEFTRIGHT", 2),
    ("FOOTAGE", "Off", "A marker or a keypoint is not where the motion puts it", "TRACKER", 3),
)


def _chosen(review: PropertyGroup, context: Context) -> None:
    if review.active_weak_frame < len(review.weak_frames):
        show_frame(review.id_data, review.weak_frames[review.active_weak_frame].frame)


class KEYMARK_PG_weak_frame(bpy.types.PropertyGroup):
    """A frame worth another keyframe."""

    frame: Number("Frame", "The scene frame")
    reason: Choice("Reason", "Reason why a keyframe helps here", items=REASONS)
    marker: Text("Marker", "Marker that is the reason, if any")
    point: Text("Body Point", "Body point whose keypoints are the reason, if any")


class KEYMARK_PG_review(bpy.types.PropertyGroup):
    """Review of a take's motion."""

    frame_count: Integer("Frames", "Reconstructed frames; 0 before the first reconstruction", min=0)
    confidence: Number(
        "Confidence",
        "Share of all joints in all frames that are expected within 2.5 % of the performer's "
        "height of their true place; negative where the method cannot tell",
        default=-1.0,
        min=-1.0,
        max=1.0,
    )
    unseen: Text("Not Seen", "In how many frames nobody is seen, and which limbs never are")
    weak_frames: Entries(type=KEYMARK_PG_weak_frame)
    active_weak_frame: Integer(
        "Weak Frame",
        "The frame chosen in the list; choosing one goes there",
        default=0,
        min=0,
        update=_chosen,
    )
