"""The reconstruction itself, free of Blender: numpy, scipy and OpenCV only."""
