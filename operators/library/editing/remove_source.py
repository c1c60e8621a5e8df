"""Remove a line from the sources of the library that is made in this file."""

import bpy

from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.requirements import idle, scene_library
from .scene_libraries import library_here


class KEYMARK_OT_remove_source(BaseOperator, bpy.types.Operator):
    """Remove a line that names a source of the postures"""

    bl_idname = "keymark.remove_source"
    bl_label = "Remove Source"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (scene_library, idle)

    line: bpy.props.IntProperty(name="Line", description="Index of the line, from 0", min=0)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Remove the line."""
        from .asset_updates import update_assets

        group = library_here(context.scene)
        if self.line >= len(group.sources):
            say(self, "ERROR", "There is no such line")
            return {"CANCELLED"}
        group.sources.remove(self.line)
        update_assets(group)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_source,))
