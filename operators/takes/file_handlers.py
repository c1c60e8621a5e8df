"""Handlers of files dropped onto an editor: footage, takes, keyframe libraries and keypoints."""

import bpy

from ..footage.take_footage import IMAGES, VIDEOS

EDITORS = {"VIEW_3D", "CLIP_EDITOR"}


def _over_an_editor(context: bpy.types.Context) -> bool:
    return context.area is not None and context.area.type in EDITORS


class KEYMARK_FH_footage(bpy.types.FileHandler):
    """Dropped videos and images are loaded as footage."""

    bl_idname = "KEYMARK_FH_footage"
    bl_label = "Footage for Keymark"
    bl_import_operator = "keymark.load_footage"
    bl_file_extensions = ";".join(VIDEOS + IMAGES)

    @classmethod
    def poll_drop(cls, context: bpy.types.Context) -> bool:
        """Over editors that show footage."""
        return _over_an_editor(context)


class KEYMARK_FH_take(bpy.types.FileHandler):
    """A dropped take.json is opened, a keyframe library imported, and keypoints are loaded."""

    bl_idname = "KEYMARK_FH_take"
    bl_label = "Take, Library or Keypoints for Keymark"
    bl_import_operator = "keymark.open_dropped"
    bl_file_extensions = ".json"

    @classmethod
    def poll_drop(cls, context: bpy.types.Context) -> bool:
        """Over editors that show footage or assets."""
        return _over_an_editor(context) or (context.area is not None and context.area.ui_type == "ASSETS")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_FH_footage, KEYMARK_FH_take))
