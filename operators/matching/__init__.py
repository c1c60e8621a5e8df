"""Keyframes matched with a library: finding them, and choosing among what a frame may show."""

PROPERTIES = ("properties",)
MODULES = ("match_library", "jump_to_match", "replace_match", "accept_match", "remove_match", "panel")
