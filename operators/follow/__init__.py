"""What is followed, in step 2: colored markers, keypoints, tracks, clicked points, contours."""

PROPERTIES = ("properties", "load_keypoints")
MODULES = ("marker_search", "marker_tools", "panel", "points", "camera_from_lines")
