"""Add a coloured marker."""

import bpy

from .takes import ensure_take
from .ui.properties.marker import SEGMENTS

USUAL_SEGMENTS = ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
"""The five that serve best, in the order in which they are offered."""


class KEYMARK_OT_add_marker(bpy.types.Operator):
    """Add a marker on the next body part that usually wears one"""

    bl_idname = "keymark.add_marker"
    bl_label = "Add Marker"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add it and make it the active one."""
        settings = ensure_take(context.scene)
        taken = {marker.segment for marker in settings.markers}
        free = [segment for segment in (*USUAL_SEGMENTS, *SEGMENTS) if segment not in taken]
        if not free:
            self.report({"ERROR"}, "Every body part has a marker already")
            return {"CANCELLED"}
        marker = settings.markers.add()
        marker.segment = marker.name = free[0]
        settings.active_marker = len(settings.markers) - 1
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_marker,))
