"""What was filmed."""

import bpy

from ...takes import active_take
from .base import TakePanel


class KEYMARK_PT_footage(TakePanel, bpy.types.Panel):
    """Clip, camera and the take's files."""

    bl_label = "Footage"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw clip, camera and the take's files."""
        take, column = active_take(context.scene), self.column()
        column.prop(take, "clip")
        column.prop(take, "camera")
        if take.camera is not None:
            column.prop(take.camera.data, "lens")
            column.prop(take.camera.data, "sensor_width")
        column.operator("keymark.load_footage", icon="FILE_MOVIE")
        row = column.row(align=True)
        row.operator("keymark.open_take", icon="FILE_FOLDER")
        row.operator("keymark.save_take", icon="FILE_TICK")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PT_footage,))
