"""Remove a colored marker."""

import bpy

from ..shell.requirements import all_met, markers
from ..shell.takes import active_take
from .properties import clear_readouts


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
        take = active_take(context.scene)
        index = min(take.active_marker, len(take.markers) - 1)
        if take.markers[index].is_picked:
            clear_readouts(take)
        take.markers.remove(index)
        take.active_marker = max(0, index - 1)
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_marker,))
