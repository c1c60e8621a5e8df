"""Step 2, what to follow: keypoints of a detector, Blender's tracks, clicked points, contours; the panels."""

PROPERTIES = ("properties",)
MODULES = ()
