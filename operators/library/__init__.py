"""Keyframe libraries: the registry of all at hand; loaded, saved, learned, and edited as pose assets."""

PROPERTIES = ("registry",)
MODULES = ("save_library", "panel")
