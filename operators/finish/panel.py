"""Panels of the finish: final Action, asset, library and export; formats are listed in `export_formats`."""

import bpy

from ..bridge.export_formats import FORMATS
from ..reconstruct.panel import draw_shown_action
from ..shell.base_operator import capitalized
from ..shell.panel import TakePanel, draw_sentence
from ..shell.step_panel import StepPanel
from ..shell.takes import active_take


class KEYMARK_PT_finish(StepPanel, bpy.types.Panel):
    """The final Action."""

    bl_label = "Finish"
    step = "finish"

    @classmethod
    def summary(cls, take: bpy.types.PropertyGroup) -> str:
        done = take.finish.action is not None
        return f"{take.finish.keys_after} keys" if done else ""

    @classmethod
    def is_wrong(cls, take: bpy.types.PropertyGroup) -> bool:
        return bool(take.finish.outdated)

    def draw_step(self, context: bpy.types.Context) -> None:
        take, column = active_take(context.scene), self.column()
        settings = take.finish
        row = column.row()
        row.scale_y = 1.4
        row.operator("keymark.bake_motion", icon="ACTION")
        column.prop(settings, "keys")
        few = column.column()
        few.active = settings.keys == "TOLERANCE"
        few.prop(settings, "tolerance_mm")
        few.prop(settings, "shared")
        column.prop(settings, "plant_feet")
        feet = column.column()
        feet.active = settings.plant_feet
        feet.prop(settings, "stray_mm")
        if settings.action is not None and take.armature is not None:
            _draw_result(column, context, take)


def _draw_result(
    column: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw the result of the last bake, and the switch between it and the motion."""
    settings = take.finish
    column.separator()
    draw_shown_action(column, take, {"MOTION": take.motion_action, "FINAL": settings.action})
    lines = column.column(align=True)
    if settings.outdated:
        draw_sentence(lines, context, "The motion is newer: bake again", "ERROR")
    kept = f"{settings.keys_after} keys instead of {settings.keys_before}"
    draw_sentence(lines, context, kept, "KEYFRAME_HLT")
    if settings.furthest_mm > 0.0:
        draw_sentence(lines, context, f"At most {settings.furthest_mm:.1f} mm off", "DRIVER_DISTANCE")
    if settings.rests:
        draw_sentence(lines, context, f"Feet planted: {settings.rests} rests", "PINNED")


class FinishPart(TakePanel):
    """Base of the sub-panels, closed by default."""

    bl_parent_id = "KEYMARK_PT_finish"
    bl_options = {"DEFAULT_CLOSED"}


class KEYMARK_PT_asset(FinishPart, bpy.types.Panel):
    """The motion as an asset."""

    bl_label = "Asset"

    def draw(self, context: bpy.types.Context) -> None:
        settings, column = active_take(context.scene).finish, self.column()
        for name in ("catalog", "tags", "author", "license", "description"):
            column.prop(settings, name)
        column.operator("keymark.mark_asset", icon="ASSET_MANAGER")


class KEYMARK_PT_export(FinishPart, bpy.types.Panel):
    """The motion for other programs."""

    bl_label = "Export"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        for kind, listed in FORMATS.items():
            missing = listed.missing()
            row = column.row()
            row.enabled = missing is None
            row.operator("keymark.export_motion", text=listed.name, icon="EXPORT").format = kind
            if missing is not None:
                column.label(text=capitalized(missing), icon="INFO", translate=False)


class KEYMARK_PT_learn(FinishPart, bpy.types.Panel):
    """The motion as a keyframe library."""

    bl_label = "Keyframe Library"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        lines = column.column(align=True)
        lines.scale_y = 0.85
        lines.label(text="The next take of its kind")
        lines.label(text="then needs fewer keyframes")
        column.operator("keymark.learn_library", icon="ASSET_MANAGER")


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_PT_finish, KEYMARK_PT_asset, KEYMARK_PT_learn, KEYMARK_PT_export)
)
