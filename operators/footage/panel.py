"""The panel of the first step: the clip, its camera, whether that is a guess, and how it can be found."""

import bpy
from bpy.types import Context, PropertyGroup, UILayout

from ..bridge.footage import fixed_reason
from ..bridge.footage_camera import may_move, solver_constraint
from ..shell.panel import Popover, StepPanel, draw_sentence
from ..shell.take_state import TakeState
from ..shell.takes import active_take, find_take
from .found_camera import HEIGHT, VERTICAL
from .load_footage import lens_is_guess
from .properties import draw_part


def _draw_camera(column: UILayout, context: Context, state: TakeState) -> None:
    scene, take, camera = context.scene, state.take, state.take.camera
    if camera.name not in scene.objects:
        column.label(text="Camera is not in the scene", icon="ERROR")
    reason = fixed_reason(camera)
    fields = column.column(align=True)
    fields.prop(camera.data, "lens")
    placed = fields.column(align=True)
    placed.enabled = reason is None
    placed.prop(take, "camera_height")
    placed.prop(take, "camera_tilt")
    if take.clip is not None and solver_constraint(scene, camera, take.clip):
        column.label(text="Camera moves as the clip was solved", icon="CON_CAMERASOLVER")
    elif may_move(camera):
        column.label(text="Camera moves; its animation is used", icon="ANIM")
    elif reason is not None:
        draw_sentence(column, context, reason, "LINKED")
    else:
        if state.placement_is_guess:
            _draw_guess(column, "Height and tilt are a guess", "keymark.keep_camera")
        found = column.column(align=True)
        found.operator("keymark.camera_from_lines", text="From Lines", icon="MOD_EDGESPLIT").kind = VERTICAL
        found.operator("keymark.camera_from_lines", text="From the Performer", icon="USER").kind = HEIGHT
        for index, sentence in enumerate(take.camera_findings.splitlines()):
            draw_sentence(column, context, sentence, "DOT" if index else "CHECKMARK")


def _draw_guess(column: UILayout, text: str, operator: str) -> None:
    row = column.row(align=True)
    row.label(text=text, translate=False, icon="QUESTION")
    row.operator(operator, text="", icon="CHECKMARK")


class KEYMARK_PT_footage(StepPanel, bpy.types.Panel):
    """The clip, and the camera that it was filmed with."""

    bl_label = "Clip"
    step = "footage"
    options = "KEYMARK_PT_footage_options"
    summary = staticmethod(lambda s: f"{s.take.clip.frame_duration} frames" if s.take.clip else "")
    is_wrong = staticmethod(lambda s: s.take.clip_state.missing)

    def draw_step(self, context: Context, body: UILayout, state: TakeState) -> None:
        take = state.take
        column = body.column()
        if take.clip is not None:
            _draw_clip(column, context, take)
        else:
            row = column.row(align=True)
            row.operator("keymark.load_footage", icon="FILE_MOVIE")
            row.menu("KEYMARK_MT_clips", text="", icon="DOWNARROW_HLT")
        if take.camera is not None:
            _draw_camera(column, context, state)
        else:
            column.prop(take, "camera")


class KEYMARK_PT_footage_options(Popover, bpy.types.Panel):
    """Another clip or camera, what is seldom known of it, its part that counts, and the take's files."""

    bl_label = "Clip Options"

    def draw(self, context: Context) -> None:
        take, column = active_take(context.scene), self.column()
        column.prop(take, "clip")
        row = column.row(align=True)
        row.operator("keymark.load_footage", text="Replace Clip", icon="FILE_MOVIE")
        row.menu("KEYMARK_MT_clips", text="", icon="DOWNARROW_HLT")
        column.prop(take, "camera")
        if take.camera is not None:
            column.prop(take.camera.data, "sensor_width")
            roll = column.row()
            roll.enabled = fixed_reason(take.camera) is None
            roll.prop(take, "camera_roll")
            if lens_is_guess(take):
                _draw_guess(column, f"Lens is a guess: {take.guessed_lens_mm:.1f} mm", "keymark.keep_lens")
        draw_part(column, take.part)
        row = column.row(align=True)
        row.operator("keymark.open_take", icon="FILE_FOLDER")
        row.operator("keymark.save_take", icon="FILE_TICK")


class KEYMARK_MT_clips(bpy.types.Menu):
    """The clips of this .blend file."""

    bl_label = "Use Clip of This File"

    def draw(self, context: Context) -> None:
        take = find_take(context.scene)
        for clip in bpy.data.movieclips:
            entry = self.layout.operator("keymark.use_clip", text=clip.name, translate=False, icon="TRACKER")
            entry.clip = clip.name
            entry.as_new_take = take is not None and take.clip is not None


def _draw_clip(column: UILayout, context: Context, take: PropertyGroup) -> None:
    clip, state = take.clip, take.clip_state
    if state.missing:
        box = column.box().column()
        box.label(text="The clip's file is missing", icon="ERROR")
        box.label(text=bpy.path.basename(clip.filepath), translate=False, icon="BLANK1")
        box.operator("keymark.relocate_clip", text="Find Clip", icon="VIEWZOOM")
        return  # Blender knows no size of a missing clip
    facts = column.column(align=True)
    facts.active = False
    size = f"{clip.size[0]} x {clip.size[1]} px at {state.rate:.5g} fps"
    draw_sentence(facts, context, size, "INFO")
    if state.variable_rate:
        draw_sentence(column, context, "Variable rate: keys lie between frames", "ERROR")
