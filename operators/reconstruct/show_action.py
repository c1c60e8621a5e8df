"""Show either the keyframes or the reconstructed motion on the actor."""

import bpy

from ..bridge.actions import assign_action
from ..shell.error_reports import reported
from ..shell.messages import say
from ..shell.requirements import actor, all_met, idle
from ..shell.takes import active_take

NOT_THERE = {
    "KEYFRAMES": "There are no keyframes yet; pose the actor and store one",
    "MOTION": "There is no motion yet; reconstruct it",
    "FINAL": "There is no final Action yet; bake it",
}


class KEYMARK_OT_show_action(bpy.types.Operator):
    """Let the keyframes or the reconstructed motion animate the actor"""

    bl_idname = "keymark.show_action"
    bl_label = "Show on Actor"
    bl_options = {"REGISTER", "UNDO"}

    which: bpy.props.EnumProperty(
        name="Show",
        description="Which of the take's Actions",
        items=[
            ("KEYFRAMES", "Keyframes", "Let the keyframes you posed animate the actor"),
            ("MOTION", "Motion", "Let the reconstructed motion animate the actor"),
            ("FINAL", "Final", "Let the finished motion animate the actor"),
        ],
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be an actor, and no job that shows it what is found."""
        return all_met(cls, context, actor, idle)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Assign the Action."""
        settings = active_take(context.scene)
        action = {
            "KEYFRAMES": settings.keyframe_action,
            "MOTION": settings.motion_action,
            "FINAL": settings.finish.action,
        }[self.which]
        if action is None:
            say(self, "ERROR", NOT_THERE[self.which])
            return {"CANCELLED"}
        with reported(self):
            assign_action(settings.armature, action)
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_show_action,))
