"""Remove a motion from the library that is made in this file."""

import bpy

from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.requirements import idle, scene_library
from .scene_libraries import active_motion, library_here


class KEYMARK_OT_remove_motion(BaseOperator, bpy.types.Operator):
    """Remove the chosen motion from the library; its postures stay"""

    bl_idname = "keymark.remove_motion"
    bl_label = "Remove Motion"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (scene_library, idle)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Remove the motion."""
        from .asset_updates import update_assets

        group = library_here(context.scene)
        if active_motion(group) is None:
            say(self, "ERROR", "No motion is chosen; choose the one to remove")
            return {"CANCELLED"}
        group.motions.remove(group.active_motion)
        group.active_motion = max(0, min(group.active_motion, len(group.motions) - 1))
        update_assets(group)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_motion,))
