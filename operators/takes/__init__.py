"""Takes: opening, saving and switching between them, and the sidebar's main panel."""

PROPERTIES = ("take_properties", "scene_properties")
MODULES = (
    "open_take",
    "save_take",
    "add_performer",
    "remove_take",
    "open_dropped",
    "file_handlers",
    "panel",
    "upgrade",
)
