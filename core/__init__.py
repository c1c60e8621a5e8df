"""The reconstruction itself, free of Blender: numpy, scipy and OpenCV only."""

import os

MOST_PIXELS = 2**27
"""Of one picture: twice a side of 8K. A damaged or malicious header claims more than memory holds."""
MOST_FRAMES = 10**6
"""Of a clip, whose pictures one folder may hold: eleven hours of film."""
FRAME_STARTS = (-MOST_FRAMES, MOST_FRAMES)
"""The first scene frame of a clip."""

# OpenCV reads it once, when it is loaded; then it looks at an image's header before it makes room for it.
os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(MOST_PIXELS))
