"""Keyframe libraries: the registry of all at hand; loaded, saved, learned, and edited as pose assets."""

PROPERTIES = ("registry",)
MODULES = ("load_library", "save_library", "panel")
