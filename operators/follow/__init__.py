"""What is followed, in step 2: colored markers, keypoints, tracks, clicked points, contours."""

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
