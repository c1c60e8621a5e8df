"""The camera in the panel of step 1: its fields, whether they are guesses, and how it can be found."""

import bpy

from ..bridge.camera_placement import fixed_reason
from ..bridge.footage_camera import may_move, solver_constraint
from ..shell.panel import draw_sentence
from ..shell.placement_guess import placement_is_guess
from .drawn_lines import HEIGHT, VERTICAL
from .take_footage import lens_is_guess


def draw_camera(
    column: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw the lens, the camera's place, whether they are guesses, and the tools that find them."""
    scene, camera = context.scene, take.camera
    column.prop(camera.data, "lens")
    column.prop(camera.data, "sensor_width")
    if camera.name not in scene.objects:
        column.label(text="Camera is not in the scene", icon="ERROR")
    if lens_is_guess(take):
        text = f"Lens is a guess: {take.guessed_lens_mm:.1f} mm"
        _draw_guess(column, text, "keymark.keep_lens")
    reason = fixed_reason(camera)
    fields = column.column()
    fields.enabled = reason is None
    fields.prop(take, "camera_height")
    fields.prop(take, "camera_tilt")
    fields.prop(take, "camera_roll")
    if take.clip is not None and solver_constraint(scene, camera, take.clip):
        column.label(text="Camera moves as the clip was solved", icon="CON_CAMERASOLVER")
    elif may_move(camera):
        column.label(text="Camera moves; its animation is used", icon="ANIM")
    elif reason is not None:
        draw_sentence(column, context, reason, "LINKED")
    else:
        _draw_tools(column, context, take)
    column.prop(scene.keymark.overlays, "show_floor_grid")


def _draw_tools(
    column: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw whether the place is a guess, the tools that find it, and what they found."""
    if placement_is_guess(take):
        _draw_guess(column, "Height and tilt are a guess", "keymark.keep_camera")
    buttons = column.column(align=True)
    buttons.operator("keymark.camera_from_lines", text="From Lines", icon="MOD_EDGESPLIT").kind = VERTICAL
    buttons.operator("keymark.camera_from_lines", text="From the Performer", icon="USER").kind = HEIGHT
    for index, sentence in enumerate(take.camera_findings.splitlines()):
        draw_sentence(column, context, sentence, "DOT" if index else "CHECKMARK")


def _draw_guess(column: bpy.types.UILayout, text: str, operator: str) -> None:
    row = column.row(align=True)
    row.label(text=text, translate=False, icon="QUESTION")
    row.operator(operator, text="", icon="CHECKMARK")
