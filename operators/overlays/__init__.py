"""Overlays drawn over Blender's editors; a new one is a draw function and a line in `registry.OVERLAYS`.

Draw functions use only what is in memory and read no file.
"""

PROPERTIES = ("properties",)
MODULES = ("panel", "mask", "registry")
