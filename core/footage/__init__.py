"""What was seen: the camera, the clip, and the coloured markers found in it."""
