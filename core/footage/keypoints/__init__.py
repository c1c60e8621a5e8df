"""Keypoints: named points of the body seen in the image by a detector, Blender's tracks or a person."""
