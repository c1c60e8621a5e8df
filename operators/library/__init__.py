"""Keyframe libraries: the registry of all at hand; loaded, saved, learned, and edited as pose assets."""

PROPERTIES = ("registry_properties",)
MODULES = (
    "import_library",
    "export_library",
    "edit_library",
    "learn_library",
    "refresh_registry",
    "panel",
)
