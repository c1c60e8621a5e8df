"""Add a line to the sources of the library that is made in this file."""

import bpy

from ...shell.base_operator import BaseOperator
from ...shell.requirements import idle, scene_library
from .scene_libraries import library_here


class KEYMARK_OT_add_source(BaseOperator, bpy.types.Operator):
    """Add a line that names a source of the postures"""

    bl_idname = "keymark.add_source"
    bl_label = "Add Source"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (scene_library, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Add an empty line."""
        library_here(context.scene).sources.add()


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_source,))
