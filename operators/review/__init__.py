"""The review in step 4: confidence of the motion, and frames worth another keyframe."""

PROPERTIES = ("properties",)
MODULES = ("weak_frames",)
