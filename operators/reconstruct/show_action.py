"""Show keyframes, motion or final Action on the actor."""

import bpy

from ..bridge.actions import assign_action
from ..shell.base_operator import BaseOperator
from ..shell.keyframe_action import straighten_unposed
from ..shell.requirements import actor, idle
from ..shell.takes import active_take

MISSING = {
    "KEYFRAMES": "There are no keyframes yet; pose the actor and store one",
    "MOTION": "There is no motion yet; reconstruct it",
    "FINAL": "There is no final Action yet; bake it",
}


class KEYMARK_OT_show_action(BaseOperator, bpy.types.Operator):
    """Animate the actor by its keyframes, the reconstructed motion or the final Action"""

    bl_idname = "keymark.show_action"
    bl_label = "Show on Actor"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, idle)

    which: bpy.props.EnumProperty(
        name="Show",
        description="Action of the take to show",
        items=[
            ("KEYFRAMES", "Keyframes", "Animate the actor by its keyframes"),
            ("MOTION", "Motion", "Animate the actor by the reconstructed motion"),
            ("FINAL", "Final", "Animate the actor by the final Action"),
        ],
    )

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Assign the Action."""
        settings = active_take(context.scene)
        action = {
            "KEYFRAMES": settings.keyframe_action,
            "MOTION": settings.motion_action,
            "FINAL": settings.finish.action,
        }[self.which]
        if action is None:
            self.report({"ERROR"}, MISSING[self.which])
            return {"CANCELLED"}
        if self.which == "KEYFRAMES":
            straighten_unposed(settings)
        assign_action(settings.armature, action)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_show_action,))
