"""Where to pose."""

import bpy

from ...takes import active_take
from .base import TakePanel


class KEYMARK_PT_keyframes(TakePanel, bpy.types.Panel):
    """Proposals, and storing the pose."""

    bl_label = "Keyframes"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw proposals and what stores a pose."""
        take, column = active_take(context.scene), self.column()
        row = column.row(align=True)
        row.operator("keymark.jump_to_proposal", text="", icon="PREV_KEYFRAME").direction = "PREVIOUS"
        row.operator("keymark.store_keyframe", icon="KEY_HLT")
        row.operator("keymark.jump_to_proposal", text="", icon="NEXT_KEYFRAME").direction = "NEXT"
        column.separator()
        column.prop(take, "keyframe_count")
        column.operator("keymark.propose_keyframes", icon="MARKER_HLT")
        column.separator()
        column.prop(take, "keyframe_action", text="Action")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PT_keyframes,))
