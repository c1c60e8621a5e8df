"""Add the five usual markers."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.takes import ensure_take
from .new_markers import USUAL_SEGMENTS, append_marker


class KEYMARK_OT_add_usual_markers(BaseOperator, bpy.types.Operator):
    """Add the five markers that help most: trunk, both forearms and both shins"""

    bl_idname = "keymark.add_usual_markers"
    bl_label = "Add Usual Five"
    bl_options = {"REGISTER", "UNDO"}

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Add the missing ones; the first of them becomes the active marker."""
        take = ensure_take(context.scene)
        marked = {marker.segment for marker in take.markers}
        missing = [segment for segment in USUAL_SEGMENTS if segment not in marked]
        if not missing:
            self.report({"INFO"}, "Trunk, forearms and shins have markers already")
            return {"CANCELLED"}
        first = len(take.markers)
        for segment in missing:
            append_marker(take, segment)
        take.active_marker = first
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_usual_markers,))
