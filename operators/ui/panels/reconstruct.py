"""From keyframes to the motion."""

import bpy

from ...takes import active_take
from .base import TakePanel


class KEYMARK_PT_reconstruct(TakePanel, bpy.types.Panel):
    """Reconstructing, and what the actor shows."""

    bl_label = "Reconstruct"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the button, the method and the switch between keyframes and motion."""
        take, column = active_take(context.scene), self.column()
        row = column.row()
        row.scale_y = 1.4
        row.operator("keymark.reconstruct", icon="ARMATURE_DATA")
        column.prop(take, "method")
        _draw_show(column, take)


def _draw_show(layout: bpy.types.UILayout, take: bpy.types.PropertyGroup) -> None:
    """The switch between keyframes and motion, where there is a motion to switch to."""
    if take.armature is None or take.motion_action is None:
        return
    data = take.armature.animation_data
    shown = data.action if data else None
    row = layout.row(align=True)
    for which, action, text in (
        ("KEYFRAMES", take.keyframe_action, "Keyframes"),
        ("MOTION", take.motion_action, "Motion"),
    ):
        depress = action is not None and action == shown
        row.operator("keymark.show_action", text=text, depress=depress).which = which


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PT_reconstruct,))
