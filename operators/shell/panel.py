"""What Keymark's panels share."""

from textwrap import wrap

import bpy

from .running_jobs import job_is_running
from .takes import find_take

ESCAPE_UNITS = 2.9
"""Width of the word Esc with an icon."""
LETTER, MARGIN = 6.2, 80.0
"""Pixels that a letter of a label takes on a plain screen, and those beside the words."""


class SidebarPanel:
    """Where all of Keymark's panels are."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Keymark"


class SubPanel(SidebarPanel):
    """A panel inside the main one, with properties in Blender's two columns."""

    bl_parent_id = "KEYMARK_PT_main"
    layout: bpy.types.UILayout

    def column(self) -> bpy.types.UILayout:
        """The panel's column of properties."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()


class TakePanel(SubPanel):
    """A step of the work on the active take; there is none to show without a take."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There is a take."""
        return find_take(context.scene) is not None


def draw_progress(layout: bpy.types.UILayout, context: bpy.types.Context, job: str = "") -> bool:
    """Draw how far the running job is, on one line; return whether it runs.

    What it stands in for is a line as well, so that nothing moves when a job begins or ends: Blender draws
    panels over each other for a moment where that happens. An eyedropper that waits does no work.

    Args:
        layout: Where.
        context: Whose job.
        job: Only that of this operator, as in `keymark.reconstruct`; any by default.
    """
    progress = context.window_manager.keymark_progress
    if not progress.stage or not job_is_running(context, job):
        return False
    row = layout.row(align=True)
    percent = f"{100.0 * progress.fraction:.0f}%  {progress.stage}"  # a narrow sidebar cuts the end off
    row.progress(factor=progress.fraction, text=(job and progress.time_left) or percent)
    escape = row.row()
    escape.ui_units_x = ESCAPE_UNITS
    escape.label(text="Esc", icon="CANCEL")
    return True


def draw_sentence(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    sentence: str,
    icon: str = "DOT",
    most_lines: int | None = None,
) -> None:
    """Draw a sentence that is translated already, broken into lines as wide as the sidebar.

    Args:
        layout: Where.
        context: Whose sidebar.
        sentence: What to draw.
        icon: Before the first line.
        most_lines: What is longer ends in dots.
    """
    scale = context.preferences.system.ui_scale
    letters = max(20, int((context.region.width / scale - MARGIN) / LETTER))
    lines = layout.column(align=True)
    lines.scale_y = 0.8
    kept = sentence.replace(" %", "\N{NO-BREAK SPACE}%")
    for number, line in enumerate(wrap(kept, letters, max_lines=most_lines, placeholder=" ...")):
        lines.label(text=line, icon=icon if number == 0 else "BLANK1", translate=False)
