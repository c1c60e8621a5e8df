"""Remove a colored marker."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.requirements import markers
from ..shell.takes import active_take
from .properties import clear_readouts


class KEYMARK_OT_remove_marker(BaseOperator, bpy.types.Operator):
    """Remove the active marker"""

    bl_idname = "keymark.remove_marker"
    bl_label = "Remove Marker"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (markers,)

    def run(self, context: bpy.types.Context) -> None:
        """Remove the marker; the one before it becomes active."""
        take = active_take(context.scene)
        index = min(take.active_marker, len(take.markers) - 1)
        if take.markers[index].is_picked:
            clear_readouts(take)
        take.markers.remove(index)
        take.active_marker = max(0, index - 1)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_marker,))
