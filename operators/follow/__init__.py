"""What is followed, in step 2: colored markers, keypoints, tracks, clicked points, contours."""

PROPERTIES = ("properties", "network")
MODULES = ("marker_search", "marker_tools", "panel", "load_keypoints", "points", "camera_from_lines")
