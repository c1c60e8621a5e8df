"""Add a motion to the library that is made in this file."""

import bpy
import numpy as np

from ....core.errors import InputError
from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.redraw import refresh_asset_browsers
from ...shell.requirements import idle, scene_library
from ...shell.takes import find_take
from .scene_libraries import library_here


class KEYMARK_OT_add_motion(BaseOperator, bpy.types.Operator):
    """Add a motion to the library: a sequence of its postures, with their times"""

    bl_idname = "keymark.add_motion"
    bl_label = "Add Motion"
    bl_options = {"REGISTER", "UNDO"}

    source: bpy.props.EnumProperty(
        name="From",
        description="Postures of the motion",
        items=[
            ("POSTURES", "The Library's Postures", "All postures in their order, evenly in time"),
            ("KEYFRAMES", "The Take's Keyframes", "Each keyframe becomes a posture and comes at its time"),
        ],
    )
    motion: bpy.props.StringProperty(
        name="Name", description="Name of the motion, such as Brisk Walking", default="Motion"
    )
    duration_s: bpy.props.FloatProperty(
        name="Duration (s)",
        description="Duration of the whole motion, unless the take's keyframes give it",
        default=1.0,
        min=0.01,
        max=600.0,
    )
    cyclic: bpy.props.BoolProperty(
        name="Cyclic",
        description="After the last posture the first comes again, as in walking; the last keyframe is "
        "then that very posture",
    )

    requirements = (scene_library, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the name."""
        return context.window_manager.invoke_props_dialog(self, confirm_text="Add")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the properties that apply to the chosen source."""
        column = self.layout.column()
        column.use_property_split = True
        column.prop(self, "source")
        column.prop(self, "motion")
        if self.source == "POSTURES":
            column.prop(self, "duration_s")
        column.prop(self, "cyclic")

    def run(self, context: bpy.types.Context) -> None:
        """Add the motion, and postures for it where they are made of keyframes."""
        from .library_edits import add_keyframes, add_motion

        group = library_here(context.scene)
        if self.source == "KEYFRAMES":
            take = find_take(context.scene)
            if take is None or take.armature is None or take.keyframe_action is None:
                raise InputError("the take has no keyframes; pose the actor and store some first")
            names, time_s = add_keyframes(
                group, context.scene, take.armature, take.keyframe_action, self.motion, cyclic=self.cyclic
            )
        else:
            names = [entry.name for entry in group.postures if entry.action is not None]
            if len(names) < 2:
                raise InputError("a motion leads through two postures or more; add postures first")
            steps = np.arange(len(names) + 1) if self.cyclic else np.arange(len(names))
            time_s = self.duration_s * steps / steps[-1]
        motion = add_motion(group, self.motion, names, time_s, cyclic=self.cyclic)
        refresh_asset_browsers(context)
        say(
            self,
            "INFO",
            "'{name}' leads through {count} postures in {duration:.2f} s",
            name=motion.name,
            count=len(motion.steps),
            duration=motion.duration_s,
        )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_motion,))
