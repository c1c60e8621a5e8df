"""Step 6, the review: how far the motion can be believed, and where another keyframe helps."""

PROPERTIES = ("properties",)
MODULES = ("jump_to_weak_frame", "pose_from_motion", "panel")
