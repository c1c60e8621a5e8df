"""Show the review of a motion: the list of weak frames, and curves in the Graph Editor."""

import bpy

from ...core.review.review import Review
from ..bridge.review_curves import write_review_curves
from ..shell.results import clear_review


def show_review(take: bpy.types.PropertyGroup, review: Review) -> None:
    """Fill a take's review and write the curves into its motion's Action.

    Args:
        take: A take whose motion was written.
        review: The review of that motion.
    """
    shown = take.review
    clear_review(take)
    shown.frame_count = len(review.frames)
    believed = float(review.confidence.mean())
    shown.confidence = believed if believed == believed else -1.0  # NaN: the method cannot tell
    for weak in review.weak_frames:
        item = shown.weak_frames.add()
        item.frame = review.frames[weak.index]
        item.reason = weak.reason.name
        item.marker = "" if weak.marker is None else review.marker_names[weak.marker]
        item.point = weak.point or ""
        item.strength = weak.strength
    write_review_curves(take.armature, take.motion_action, review)
