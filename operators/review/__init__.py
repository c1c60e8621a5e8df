"""Step 6, the review: confidence of the motion, and frames worth another keyframe."""

PROPERTIES = ("properties",)
MODULES = ("jump_to_weak_frame", "pose_from_motion", "look_from_side", "panel")
