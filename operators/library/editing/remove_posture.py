"""The list of postures of the library that is made in this file: taking one out, putting them in order."""

import bpy

from ...shell.error_reports import reported
from ...shell.messages import say
from ...shell.redraw import refresh_asset_browsers
from ...shell.requirements import all_met, idle, scene_library
from .scene_libraries import active_posture, library_here, show_again


class KEYMARK_OT_remove_posture(bpy.types.Operator):
    """Take the chosen posture out of the library, with its pose asset; motions lose their steps to it"""

    bl_idname = "keymark.remove_posture"
    bl_label = "Remove Posture"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a library."""
        return all_met(cls, context, scene_library, idle)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove entry, Action and steps."""
        with reported(self):
            group = library_here(context.scene)
            entry = active_posture(group)
            if entry is None:
                say(self, "ERROR", "No posture is chosen; choose the one to remove")
                return {"CANCELLED"}
            name, action = entry.name, entry.action
            for motion in group.motions:
                for place in reversed(range(len(motion.steps))):
                    if motion.steps[place].posture == name:
                        motion.steps.remove(place)
            group.postures.remove(group.active_posture)
            group.active_posture = max(0, min(group.active_posture, len(group.postures) - 1))
            if action is not None:
                bpy.data.actions.remove(action)
            show_again(group)
            refresh_asset_browsers(context)
            say(self, "INFO", "Removed '{name}'", name=name)
            return {"FINISHED"}
        return {"CANCELLED"}


class KEYMARK_OT_move_posture(bpy.types.Operator):
    """Move the chosen posture up or down in the library's order"""

    bl_idname = "keymark.move_posture"
    bl_label = "Move Posture"
    bl_options = {"REGISTER", "UNDO"}

    direction: bpy.props.EnumProperty(
        name="Direction",
        description="Where to",
        items=[("UP", "Up", "Before the posture above"), ("DOWN", "Down", "Behind the posture below")],
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a library."""
        return all_met(cls, context, scene_library, idle)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Exchange two entries."""
        with reported(self):
            group = library_here(context.scene)
            before = group.active_posture
            after = before + (-1 if self.direction == "UP" else 1)
            if not (0 <= after < len(group.postures) and before < len(group.postures)):
                return {"CANCELLED"}
            group.postures.move(before, after)
            group.active_posture = after
            show_again(group)
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_OT_remove_posture, KEYMARK_OT_move_posture)
)
