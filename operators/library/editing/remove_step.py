"""Remove a step from a motion of the library that is made in this file."""

import bpy

from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.requirements import idle, scene_library
from .scene_libraries import active_motion, library_here


class KEYMARK_OT_remove_step(BaseOperator, bpy.types.Operator):
    """Remove the chosen step from the motion; the posture stays in the library"""

    bl_idname = "keymark.remove_step"
    bl_label = "Remove Step"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (scene_library, idle)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Remove the step."""
        from .asset_updates import update_assets

        group = library_here(context.scene)
        motion = active_motion(group)
        if motion is None or motion.active_step >= len(motion.steps):
            say(self, "ERROR", "No step is chosen; choose the one to remove")
            return {"CANCELLED"}
        motion.steps.remove(motion.active_step)
        motion.active_step = max(0, min(motion.active_step, len(motion.steps) - 1))
        update_assets(group)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_step,))
