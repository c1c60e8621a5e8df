"""Step 2 beside the markers: keypoints of a detector, Blender's tracks and clicked points."""

MODULES = ()
