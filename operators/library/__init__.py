"""Keyframe libraries: the registry of all at hand, and (in `editing/`) the one made in this file."""

PROPERTIES = ("editing.properties", "registry_properties")
MODULES = (
    "import_library",
    "export_library",
    "install_library",
    "install_shipped_libraries",
    "delete_library",
    "refresh_registry",
    "publish_library",
    "learn_library",
    "apply_posture",
    "editing.new_library",
    "editing.edit_library",
    "editing.gather_library",
    "editing.unlink_library",
    "editing.add_posture",
    "editing.remove_posture",
    "editing.move_posture",
    "editing.add_motion",
    "editing.remove_motion",
    "editing.add_step",
    "editing.remove_step",
    "editing.add_source",
    "editing.remove_source",
    "editing.mirror_library",
    "panel",
)
