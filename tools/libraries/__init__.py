"""Keyframe libraries composed from what literature says of joints and feet, for make_libraries.py."""
