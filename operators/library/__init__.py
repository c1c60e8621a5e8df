"""Keyframe libraries: those at hand, and (in `editing/`) the one that is made in this file."""

PROPERTIES = ("editing.properties", "registry_properties")
MODULES = (
    "import_library",
    "export_library",
    "install_library",
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
    "editing.add_motion",
    "editing.remove_motion",
    "editing.mirror_library",
    "panel",
)
