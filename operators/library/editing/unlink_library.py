"""Remove a keyframe library from this file."""

import bpy

from ...shell.error_reports import reported
from ...shell.messages import say
from ...shell.redraw import refresh_asset_browsers
from ...shell.requirements import all_met, idle, scene_library
from .scene_libraries import library_here


class KEYMARK_OT_remove_library(bpy.types.Operator):
    """Remove the library from this file, with its pose assets; files that it was exported to stay"""

    bl_idname = "keymark.remove_library"
    bl_label = "Remove from This File"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be one."""
        return all_met(cls, context, scene_library, idle)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove it and its Actions."""
        with reported(self):
            settings = context.scene.keymark
            group = library_here(context.scene)
            title = group.name
            actions = [entry.action for entry in group.postures if entry.action is not None]
            place = list(settings.libraries).index(group)
            settings.libraries.remove(place)
            settings.active_library = max(0, min(place, len(settings.libraries) - 1))
            bpy.data.batch_remove(actions)
            refresh_asset_browsers(context)
            say(self, "INFO", "Removed '{title}' from this file", title=title)
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_library,))
