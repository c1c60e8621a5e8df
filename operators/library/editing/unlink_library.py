"""Unlink a keyframe library from this file."""

import bpy

from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.redraw import refresh_asset_browsers
from ...shell.requirements import idle, scene_library
from .scene_libraries import library_here


class KEYMARK_OT_remove_library(BaseOperator, bpy.types.Operator):
    """Remove the library from this file, with its pose assets; files that it was exported to stay"""

    bl_idname = "keymark.remove_library"
    bl_label = "Remove from This File"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (scene_library, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Remove the library and its Actions."""
        settings = context.scene.keymark
        group = library_here(context.scene)
        title = group.name
        actions = [entry.action for entry in group.postures if entry.action is not None]
        index = list(settings.libraries).index(group)
        settings.libraries.remove(index)
        settings.active_library = max(0, min(index, len(settings.libraries) - 1))
        bpy.data.batch_remove(actions)
        refresh_asset_browsers(context)
        say(self, "INFO", "Removed '{title}' from this file", title=title)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_library,))
