"""Step 6, the review: confidence of the motion, and frames worth another keyframe."""

PROPERTIES = ("properties",)
MODULES = ("weak_frames", "panel")
