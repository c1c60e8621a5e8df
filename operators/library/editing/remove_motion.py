"""The motions of the library that is made in this file: their steps, and taking one out."""

import bpy

from ...shell.error_reports import reported
from ...shell.messages import say
from ...shell.requirements import all_met, idle, scene_library
from .scene_libraries import active_motion, active_posture, library_here, show_again

STEP_S = 0.1
"""After the last step, where nothing tells when the next one comes."""


class MotionOperator:
    """What changes a motion, or the library's details."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a library."""
        return all_met(cls, context, scene_library, idle)


class KEYMARK_OT_remove_motion(MotionOperator, bpy.types.Operator):
    """Take the chosen motion out of the library; its postures stay"""

    bl_idname = "keymark.remove_motion"
    bl_label = "Remove Motion"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove it."""
        with reported(self):
            group = library_here(context.scene)
            if active_motion(group) is None:
                say(self, "ERROR", "No motion is chosen; choose the one to remove")
                return {"CANCELLED"}
            group.motions.remove(group.active_motion)
            group.active_motion = max(0, min(group.active_motion, len(group.motions) - 1))
            show_again(group)
            return {"FINISHED"}
        return {"CANCELLED"}


class KEYMARK_OT_add_step(MotionOperator, bpy.types.Operator):
    """Let the chosen motion lead on to the chosen posture"""

    bl_idname = "keymark.add_step"
    bl_label = "Add Step"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add it behind the last step, as much later as that came after the one before."""
        with reported(self):
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
            return {"FINISHED"}
        return {"CANCELLED"}


class KEYMARK_OT_remove_step(MotionOperator, bpy.types.Operator):
    """Take the chosen step out of the motion; the posture stays in the library"""

    bl_idname = "keymark.remove_step"
    bl_label = "Remove Step"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove it."""
        with reported(self):
            group = library_here(context.scene)
            motion = active_motion(group)
            if motion is None or motion.active_step >= len(motion.steps):
                say(self, "ERROR", "No step is chosen; choose the one to remove")
                return {"CANCELLED"}
            motion.steps.remove(motion.active_step)
            motion.active_step = max(0, min(motion.active_step, len(motion.steps) - 1))
            show_again(group)
            return {"FINISHED"}
        return {"CANCELLED"}


class KEYMARK_OT_add_source(MotionOperator, bpy.types.Operator):
    """Add a line that says what the postures are drawn from"""

    bl_idname = "keymark.add_source"
    bl_label = "Add Source"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add an empty line."""
        with reported(self):
            library_here(context.scene).sources.add()
            return {"FINISHED"}
        return {"CANCELLED"}


class KEYMARK_OT_remove_source(MotionOperator, bpy.types.Operator):
    """Take out a line that says what the postures are drawn from"""

    bl_idname = "keymark.remove_source"
    bl_label = "Remove Source"

    line: bpy.props.IntProperty(name="Line", description="Which line, from 0", min=0)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove it."""
        with reported(self):
            group = library_here(context.scene)
            if self.line >= len(group.sources):
                say(self, "ERROR", "There is no such line")
                return {"CANCELLED"}
            group.sources.remove(self.line)
            show_again(group)
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory(
    (
        KEYMARK_OT_remove_motion,
        KEYMARK_OT_add_step,
        KEYMARK_OT_remove_step,
        KEYMARK_OT_add_source,
        KEYMARK_OT_remove_source,
    )
)
