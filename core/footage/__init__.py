"""What was seen: the camera, the clip, and the colored markers found in it."""
