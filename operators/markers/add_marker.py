"""Add a colored marker."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.takes import ensure_take
from .new_markers import append_marker, next_segment


class KEYMARK_OT_add_marker(BaseOperator, bpy.types.Operator):
    """Add a marker on the next body part that usually wears one"""

    bl_idname = "keymark.add_marker"
    bl_label = "Add Marker"
    bl_options = {"REGISTER", "UNDO"}

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Add the marker and make it the active one."""
        take = ensure_take(context.scene)
        segment = next_segment(take)
        if segment is None:
            self.report({"ERROR"}, "Every body part has a marker already")
            return {"CANCELLED"}
        append_marker(take, segment)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_marker,))
