"""The panel of the last step: final Action, asset and files; formats are listed in `export_formats`."""

import bpy
from bpy.types import Context, UILayout

from ..bridge.export_formats import FORMATS
from ..reconstruct.panel import draw_shown_action
from ..shell.panel import Popover, StepPanel, draw_progress, draw_sentence
from ..shell.take_state import TakeState
from ..shell.takes import active_take
from .bake_motion import draw_who


class KEYMARK_PT_finish(StepPanel, bpy.types.Panel):
    """The motion for other programs and other files, and its final Action."""

    bl_label = "Export"
    step = "finish"
    options = "KEYMARK_PT_finish_options"
    summary = staticmethod(lambda s: f"{s.take.finish.keys_after} keys" if s.take.finish.action else "")
    is_wrong = staticmethod(lambda s: s.final_is_outdated)
    action = staticmethod(lambda _: ("keymark.bake_motion", "Bake"))

    def draw_step(self, context: Context, body: UILayout, state: TakeState) -> None:
        take = state.take
        column = body.column()
        if state.performers:
            draw_who(column, take)
        grid = column.grid_flow(columns=2, even_columns=True, align=True)
        for kind, listed in FORMATS.items():
            each = grid.row()
            each.enabled = listed.missing() is None  # its tooltip says why
            each.operator("keymark.export_motion", text=listed.name, icon="EXPORT").format = kind
        column.separator()
        row = column.row()
        if not draw_progress(row, context, "keymark.bake_motion"):
            row.operator("keymark.bake_motion", icon="ACTION")
        made = take.finish
        if made.action is not None and take.armature is not None:
            column.separator()
            draw_shown_action(column, state, {"MOTION": take.motion_action, "FINAL": made.action})
            lines = column.column(align=True)
            if state.final_is_outdated:
                draw_sentence(lines, context, "The motion is newer: bake again", "ERROR")
            kept = f"{made.keys_after} keys instead of {made.keys_before}"
            draw_sentence(lines, context, kept, "KEYFRAME_HLT")
            if made.furthest_mm > 0.0:
                draw_sentence(lines, context, f"At most {made.furthest_mm:.1f} mm off", "DRIVER_DISTANCE")
            if made.rests:
                draw_sentence(lines, context, f"Feet planted: {made.rests} rests", "PINNED")
        column.popover("KEYMARK_PT_asset", icon="ASSET_MANAGER")


class KEYMARK_PT_finish_options(Popover, bpy.types.Panel):
    """How the final Action is made."""

    bl_label = "Options of the Final Action"

    def draw(self, context: Context) -> None:
        settings, column = active_take(context.scene).finish, self.column()
        few = settings.keys == "TOLERANCE"
        shown = {"keys": True, "tolerance_mm": few, "shared": few, "plant_feet": True}
        for name, active in {**shown, "stray_mm": settings.plant_feet}.items():
            row = column.row()
            row.active = active
            row.prop(settings, name)


class KEYMARK_PT_asset(Popover, bpy.types.Panel):
    """The motion as an asset."""

    bl_label = "Mark as Asset"

    def draw(self, context: Context) -> None:
        settings, column = active_take(context.scene).finish, self.column()
        for name in ("catalog", "tags", "author", "license", "description"):
            column.prop(settings, name)
        column.operator("keymark.mark_asset", icon="ASSET_MANAGER")
