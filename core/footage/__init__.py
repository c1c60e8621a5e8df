"""The footage: camera, clip, and the colored markers detected and tracked in it."""
