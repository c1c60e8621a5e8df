"""Who performs."""

import bpy

from ...takes import active_take
from .base import TakePanel


class KEYMARK_PT_actor(TakePanel, bpy.types.Panel):
    """The armature, and how to build one."""

    bl_label = "Actor"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the armature and how to build one."""
        take, column = active_take(context.scene), self.column()
        column.prop(take, "armature")
        column.prop(take, "stature")
        column.operator("keymark.build_actor", icon="OUTLINER_OB_ARMATURE")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PT_actor,))
