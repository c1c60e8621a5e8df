"""Files dropped onto an editor: footage is loaded, a take is opened."""

import bpy

from .load_footage import IMAGES, VIDEOS

EDITORS = {"VIEW_3D", "CLIP_EDITOR"}


def _over_an_editor(context: bpy.types.Context) -> bool:
    return context.area is not None and context.area.type in EDITORS


class KEYMARK_FH_footage(bpy.types.FileHandler):
    """Videos and images become footage."""

    bl_idname = "KEYMARK_FH_footage"
    bl_label = "Footage for Keymark"
    bl_import_operator = "keymark.load_footage"
    bl_file_extensions = ";".join(VIDEOS + IMAGES)

    @classmethod
    def poll_drop(cls, context: bpy.types.Context) -> bool:
        """Where footage is shown."""
        return _over_an_editor(context)


class KEYMARK_FH_take(bpy.types.FileHandler):
    """A take.json opens its take."""

    bl_idname = "KEYMARK_FH_take"
    bl_label = "Take for Keymark"
    bl_import_operator = "keymark.open_take"
    bl_file_extensions = ".json"

    @classmethod
    def poll_drop(cls, context: bpy.types.Context) -> bool:
        """Where footage is shown."""
        return _over_an_editor(context)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_FH_footage, KEYMARK_FH_take))
