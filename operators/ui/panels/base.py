"""What Keymark's panels share."""

import bpy

from ...running.job_operator import job_is_running
from ...scene.takes import find_take


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


def draw_progress(layout: bpy.types.UILayout, context: bpy.types.Context) -> bool:
    """Draw how far the running job is; return whether one runs. An eyedropper that waits does no work."""
    progress = context.window_manager.keymark_progress
    if not job_is_running(context) or not progress.stage:
        return False
    percent = f"{progress.stage} ({100.0 * progress.fraction:.0f}%)"
    layout.progress(factor=progress.fraction, text=percent)
    row = layout.row()
    row.label(text="Esc cancels", icon="CANCEL")
    row.label(text=progress.time_left, translate=False)
    return True
