"""Takes: their properties, opening and saving them, the sidebar's main panel, and files of other versions."""

PROPERTIES = ("take_properties", "scene_properties")
MODULES = (
    "open_take",
    "open_example",
    "save_take",
    "add_performer",
    "remove_take",
    "open_dropped",
    "file_handlers",
    "panel",
    "upgrade",
)
