"""What is drawn over Blender's editors, from what is in memory: a draw function reads no file."""

PROPERTIES = ("properties", "timeline_properties")
MODULES = ("panel", "mask", "registry")
