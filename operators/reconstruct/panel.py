"""Panel of the reconstruction."""

import bpy

from ..shell.panel import TakePanel, draw_progress, draw_sentence
from ..shell.step_panel import StepPanel
from ..shell.takes import active_take, find_take


class KEYMARK_PT_reconstruct(StepPanel, bpy.types.Panel):
    """Reconstruction, and the Action on the actor."""

    bl_label = "Reconstruct"
    step = "reconstruct"

    def draw_step(self, context: bpy.types.Context) -> None:
        take, column = active_take(context.scene), self.column()
        row = column.row()
        row.scale_y = 1.4
        if not draw_progress(row, context, "keymark.reconstruct"):
            row.operator("keymark.reconstruct", icon="ARMATURE_DATA")
        column.prop(take, "method")
        column.prop(take, "live_preview")
        if take.armature is not None and take.motion_action is not None:
            actions = {"KEYFRAMES": take.keyframe_action, "MOTION": take.motion_action}
            draw_shown_action(column, take, actions)


def draw_shown_action(
    layout: bpy.types.UILayout, take: bpy.types.PropertyGroup, actions: dict[str, bpy.types.Action | None]
) -> None:
    """Draw the switch between Actions on the actor, by the names of `keymark.show_action`."""
    data = take.armature.animation_data
    shown = data.action if data else None
    row = layout.row(align=True)
    for which, action in actions.items():
        depress = action is not None and action == shown
        button = row.operator("keymark.show_action", text=which.title(), depress=depress, translate=False)
        button.which = which


class KEYMARK_PT_reconstruct_notes(TakePanel, bpy.types.Panel):
    """Notes of the last reconstruction."""

    bl_label = "Notes"
    bl_parent_id = "KEYMARK_PT_reconstruct"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        take = find_take(context.scene)
        return super().poll(context) and take is not None and len(take.notes) > 0

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.label(text="", icon="INFO")

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column()
        for note in active_take(context.scene).notes:
            draw_sentence(column, context, note.text)


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_PT_reconstruct, KEYMARK_PT_reconstruct_notes)
)
