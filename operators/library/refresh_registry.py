"""Refresh the registry of keyframe libraries."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle
from .registry import refresh


class KEYMARK_OT_refresh_shelf(BaseOperator, bpy.types.Operator):
    """Read the folder of your libraries again, after other programs have changed its files"""

    bl_idname = "keymark.refresh_shelf"
    bl_label = "Refresh Libraries"
    bl_options = {"REGISTER"}
    requirements = (idle,)

    def run(self, context: bpy.types.Context) -> None:
        """Read the folders."""
        refresh()
        count = len(context.window_manager.keymark_shelf.libraries)
        self.report({"INFO"}, f"{count} keyframe libraries are at hand")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_refresh_shelf,))
