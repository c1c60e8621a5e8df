"""Keymark in Blender's user interface and on its command line: one operator a file.

Nothing is imported before `register()`: the command line of an ordinary Python shares this folder.
"""

from importlib import import_module
from types import ModuleType

MODULES = (
    "ui.properties.actor",
    "ui.properties.marker",
    "ui.properties.turntable",
    "ui.properties.clip_state",
    "ui.properties.review",
    "ui.properties.finish",
    "ui.properties.match",
    "ui.properties.take",
    "ui.properties.timeline",
    "ui.properties.progress",
    "ui.properties.overlays",
    "ui.properties.library",
    "ui.properties.scene",
    "ui.properties.shelf",
    "scene.results",
    "scene.posed_frames",
    "open_take",
    "save_take",
    "load_footage",
    "use_clip",
    "relocate_clip",
    "keep_lens",
    "add_performer",
    "remove_take",
    "import_library",
    "export_library",
    "install_library",
    "discard_library",
    "refresh_shelf",
    "open_dropped",
    "drop_files",
    "new_library",
    "edit_library",
    "gather_library",
    "keep_library",
    "remove_library",
    "add_posture",
    "edit_postures",
    "add_motion",
    "edit_motions",
    "mirror_library",
    "apply_posture",
    "build_actor",
    "measure_actor",
    "apply_lengths",
    "add_marker",
    "remove_marker",
    "check_markers",
    "pick_marker_color",
    "show_masks",
    "propose_keyframes",
    "jump_to_proposal",
    "match_library",
    "jump_to_match",
    "replace_match",
    "accept_match",
    "remove_match",
    "fit_pose",
    "store_keyframe",
    "reconstruct",
    "show_action",
    "bake_motion",
    "mark_asset",
    "export_motion",
    "learn_library",
    "set_up_turntable",
    "remove_turntable",
    "show_view",
    "jump_to_weak_frame",
    "pose_from_motion",
    "ui.panels.main",
    "ui.panels.footage",
    "ui.panels.markers",
    "ui.panels.actor",
    "ui.panels.keyframes",
    "ui.panels.matches",
    "ui.panels.reconstruct",
    "ui.panels.review",
    "ui.panels.overlays",
    "ui.panels.turntable",
    "ui.panels.finish",
    "ui.panels.library",
    "ui.overlays.mask",
    "ui.overlays.registry",
    "command",
    "scene.upgrade",
)
"""What is registered, in this order: properties before the operators and panels that use them."""


def register() -> None:
    """Register every module in order; if one fails, take back those before it and raise."""
    done: list[ModuleType] = []
    try:
        for name in MODULES:
            module = import_module(f".{name}", __package__)
            module.register()
            done.append(module)
    except Exception:
        for module in reversed(done):
            module.unregister()
        raise


def unregister() -> None:
    """Unregister every module, in the reverse order."""
    for name in reversed(MODULES):
        import_module(f".{name}", __package__).unregister()
