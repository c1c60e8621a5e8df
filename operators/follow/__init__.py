"""Step 2, what to follow: colored markers, keypoints, tracks, clicked points, contours; the panels."""

PROPERTIES = ("marker_properties", "keypoint_properties")
MODULES = (
    "marker_list",
    "pick_marker_color",
    "ignore_region",
    "panel",
    "marker_panel",
    "load_keypoints",
    "click_points",
    "tracks",
    "camera_from_lines",
    "keypoint_panel",
)
