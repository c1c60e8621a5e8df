"""Takes: their properties, opening and saving them, the sidebar's main panel, and files of other versions."""

PROPERTIES = ("properties",)
MODULES = ("open_take", "take_list", "panel", "upgrade")
