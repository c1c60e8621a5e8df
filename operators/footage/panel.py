"""The panel of step 1: clip, camera and the take's files."""

import bpy

from ..shell.panel import draw_sentence, side_by_side
from ..shell.step_panel import StepPanel
from ..shell.takes import active_take, find_take
from .camera_panel import draw_camera


class KEYMARK_PT_footage(StepPanel, bpy.types.Panel):
    """Clip, camera and the take's files."""

    bl_label = "Footage"
    step = "footage"

    @classmethod
    def summary(cls, take: bpy.types.PropertyGroup) -> str:
        """How long the clip is."""
        return f"{take.clip.frame_duration} frames" if take.clip is not None else ""

    @classmethod
    def is_wrong(cls, take: bpy.types.PropertyGroup) -> bool:
        """Whether the clip's file is missing."""
        return bool(take.clip_state.missing)

    def draw_step(self, context: bpy.types.Context) -> None:
        """Draw clip, camera and the take's files."""
        take, column = active_take(context.scene), self.column()
        column.prop(take, "clip")
        if take.clip is not None:
            _draw_clip(column, context, take)
        column.separator()
        column.prop(take, "camera")
        if take.camera is not None:
            draw_camera(column, context, take)
        column.separator()
        row = column.row(align=True)
        text = "Load Footage" if take.clip is None else "Replace Clip"
        row.operator("keymark.load_footage", text=text, icon="FILE_MOVIE", translate=False)
        row.menu("KEYMARK_MT_clips", text="", icon="DOWNARROW_HLT")
        row = side_by_side(column)
        row.operator("keymark.open_take", icon="FILE_FOLDER")
        row.operator("keymark.save_take", icon="FILE_TICK")


class KEYMARK_MT_clips(bpy.types.Menu):
    """The clips of this .blend file."""

    bl_label = "Use Clip of This File"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw one entry a clip."""
        take = find_take(context.scene)
        for clip in bpy.data.movieclips:
            entry = self.layout.operator("keymark.use_clip", text=clip.name, translate=False, icon="TRACKER")
            entry.clip = clip.name
            entry.as_new_take = take is not None and take.clip is not None


def _draw_clip(column: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup) -> None:
    """Draw the clip's size, length and rate, or that its file is missing."""
    clip, state = take.clip, take.clip_state
    if state.missing:
        box = column.box().column()
        box.label(text="The clip's file is missing", icon="ERROR")
        box.label(text=bpy.path.basename(clip.filepath), translate=False, icon="BLANK1")
        box.operator("keymark.relocate_clip", text="Find Clip", icon="VIEWZOOM")
        return  # Blender knows no size of a missing clip
    facts = column.column(align=True)
    facts.active = False
    size = f"{clip.size[0]} x {clip.size[1]} px"
    extent = f"{clip.frame_duration} frames at {state.rate:.5g} fps"
    draw_sentence(facts, context, f"{size}, {extent}", "INFO")
    if state.variable_rate:
        draw_sentence(column, context, "Variable rate: keys lie between frames", "ERROR")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_MT_clips, KEYMARK_PT_footage))
