"""Add a step to a motion of the library that is made in this file."""

import bpy

from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.requirements import idle, scene_library
from .scene_libraries import active_motion, active_posture, library_here

STEP_S = 0.1
"""Time of a new step after the last one, where no earlier steps give it."""


class KEYMARK_OT_add_step(BaseOperator, bpy.types.Operator):
    """Add the chosen posture at the end of the chosen motion"""

    bl_idname = "keymark.add_step"
    bl_label = "Add Step"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (scene_library, idle)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Add a step, as much later than the last one as that is later than the one before."""
        group = library_here(context.scene)
        motion, entry = active_motion(group), active_posture(group)
        if motion is None or entry is None:
            say(self, "ERROR", "Choose a motion and a posture first")
            return {"CANCELLED"}
        times = [step.time_s for step in motion.steps]
        later = times[-1] - times[-2] if len(times) > 1 else STEP_S
        when = times[-1] + later if times else 0.0
        step = motion.steps.add()
        step.posture, step.time_s = entry.name, when
        needed = when + (later if motion.cyclic else 0.0)
        motion.duration_s = max(motion.duration_s, needed, STEP_S)
        motion.active_step = len(motion.steps) - 1
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_step,))
