"""The panel of the fourth step: the motion, and the review of it."""

import bpy
from bpy.types import Action, Context, UILayout

from ..review.weak_frames import draw_review
from ..shell.panel import Popover, StepPanel, draw_progress, draw_sentence
from ..shell.take_state import TakeState
from ..shell.takes import active_take


class KEYMARK_PT_reconstruct(StepPanel, bpy.types.Panel):
    """Reconstruction, the Action on the actor, and how sure the motion is."""

    bl_label = "Motion"
    step = "reconstruct"
    options = "KEYMARK_PT_reconstruct_options"
    summary = staticmethod(lambda s: f"{count} weak" if (count := len(s.take.review.weak_frames)) else "")
    action = staticmethod(lambda _: ("keymark.reconstruct", "Reconstruct"))

    def draw_step(self, context: Context, body: UILayout, state: TakeState) -> None:
        take = state.take
        column = body.column()
        row = column.row()
        row.scale_y = 1.4
        if not draw_progress(row, context, "keymark.reconstruct"):
            row.operator("keymark.reconstruct", icon="ARMATURE_DATA")
        if take.armature is not None and take.motion_action is not None:
            draw_shown_action(
                column, state, {"KEYFRAMES": take.keyframe_action, "MOTION": take.motion_action}
            )
        if take.review.unseen:
            draw_sentence(column, context, take.review.unseen, "HIDE_ON")
        if len(take.notes):
            text = "1 Note" if len(take.notes) == 1 else f"{len(take.notes)} Notes"
            column.popover("KEYMARK_PT_reconstruct_notes", text=text, icon="INFO", translate=False)
        if take.review.frame_count:
            draw_review(column, context, state)


def draw_shown_action(layout: UILayout, state: TakeState, actions: dict[str, Action | None]) -> None:
    """Draw the switch between Actions on the actor, by the names of `keymark.show_action`."""
    row = layout.row(align=True)
    for which, action in actions.items():
        depress = action is not None and action == state.shown_action
        button = row.operator("keymark.show_action", text=which.title(), depress=depress, translate=False)
        button.which = which


class KEYMARK_PT_reconstruct_options(Popover, bpy.types.Panel):
    """How the motion is made."""

    bl_label = "Options of the Motion"

    def draw(self, context: Context) -> None:
        take, column = active_take(context.scene), self.column()
        column.prop(take.follow, "reference")
        column.prop(take, "method")
        column.prop(take, "live_preview")


class KEYMARK_PT_reconstruct_notes(Popover, bpy.types.Panel):
    """Notes of the last reconstruction."""

    bl_label = "Notes"

    def draw(self, context: Context) -> None:
        column = self.layout.column()
        for note in active_take(context.scene).notes:
            draw_sentence(column, context, note.text)
