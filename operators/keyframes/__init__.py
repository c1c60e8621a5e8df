"""Step 3, the poses: poses found in the footage or posed by hand, proposed frames, corrections."""

PROPERTIES = ("found_properties",)
MODULES = ("posing", "corrections", "drag_joints", "panel", "pose_all", "change_match")
