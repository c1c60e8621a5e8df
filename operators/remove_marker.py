"""Remove a coloured marker."""

import bpy

from .requirements import all_met, markers
from .takes import active_take


class KEYMARK_OT_remove_marker(bpy.types.Operator):
    """Remove the active marker"""

    bl_idname = "keymark.remove_marker"
    bl_label = "Remove Marker"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be one."""
        return all_met(cls, context, markers)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove it; the one before becomes active."""
        settings = active_take(context.scene)
        index = min(settings.active_marker, len(settings.markers) - 1)
        settings.markers.remove(index)
        settings.active_marker = max(0, index - 1)
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_marker,))
