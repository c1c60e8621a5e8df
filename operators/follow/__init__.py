"""What is followed, in step 2: colored markers, keypoints, tracks, clicked points, contours."""

PROPERTIES = ("marker_properties", "keypoint_properties", "network")
MODULES = (
    "marker_search",
    "pick_marker_color",
    "ignore_region",
    "panel",
    "load_keypoints",
    "click_points",
    "tracks",
    "camera_from_lines",
)
