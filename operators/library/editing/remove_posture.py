"""Remove a posture from the library that is made in this file."""

import bpy

from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.redraw import refresh_asset_browsers
from ...shell.requirements import idle, scene_library
from .scene_libraries import active_posture, library_here


class KEYMARK_OT_remove_posture(BaseOperator, bpy.types.Operator):
    """Remove the chosen posture from the library, with its pose asset and the motions' steps to it"""

    bl_idname = "keymark.remove_posture"
    bl_label = "Remove Posture"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (scene_library, idle)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Remove entry, Action and steps."""
        from .asset_updates import update_assets

        group = library_here(context.scene)
        entry = active_posture(group)
        if entry is None:
            say(self, "ERROR", "No posture is chosen; choose the one to remove")
            return {"CANCELLED"}
        name, action = entry.name, entry.action
        for motion in group.motions:
            for index in reversed(range(len(motion.steps))):
                if motion.steps[index].posture == name:
                    motion.steps.remove(index)
        group.postures.remove(group.active_posture)
        group.active_posture = max(0, min(group.active_posture, len(group.postures) - 1))
        if action is not None:
            bpy.data.actions.remove(action)
        update_assets(group)
        refresh_asset_browsers(context)
        say(self, "INFO", "Removed '{name}'", name=name)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_posture,))
