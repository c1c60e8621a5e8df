"""Matching of footage with libraries: finding keyframes, and choosing among a frame's candidates."""

PROPERTIES = ("properties",)
MODULES = ("match_library", "jump_to_match", "replace_match", "accept_match", "remove_match", "panel")
