"""Look again at which keyframe libraries there are."""

import bpy

from ..shell.error_reports import reported
from ..shell.messages import say
from ..shell.requirements import all_met, idle
from .registry import fill


class KEYMARK_OT_refresh_shelf(bpy.types.Operator):
    """Look again at the folder of your libraries, after files were put there by other programs"""

    bl_idname = "keymark.refresh_shelf"
    bl_label = "Refresh Libraries"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Not while a job runs."""
        return all_met(cls, context, idle)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Read the folder."""
        with reported(self):
            fill()
            count = len(context.window_manager.keymark_shelf.libraries)
            say(self, "INFO", "{count} keyframe libraries are at hand", count=count)
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_refresh_shelf,))
