"""Step 2, what to follow: keypoints of a detector, Blender's tracks, clicked points, contours; the panels."""

PROPERTIES = ("properties",)
MODULES = (
    "detect_keypoints",
    "load_keypoints",
    "remove_keypoints",
    "click_point",
    "remove_clicks",
    "click_performer",
    "assign_track",
    "camera_from_lines",
    "panel",
)
