"""Give the actor the lengths in the panel."""

import bpy

from ...core.body.actor import Actor
from ..shell.base_operator import BaseOperator
from ..shell.messages import say
from ..shell.notices import give_notices
from ..shell.requirements import actor, bones_editable, idle
from ..shell.takes import active_take
from .properties import panel_lengths


class KEYMARK_OT_apply_lengths(BaseOperator, bpy.types.Operator):
    """Give the actor's bones these lengths; its pose, its keyframes and the position of its hips stay"""

    bl_idname = "keymark.apply_lengths"
    bl_label = "Apply Lengths"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, bones_editable, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Resize the bones."""
        from ...core.body.kinematics import Body
        from ..bridge.resize import set_lengths

        take = active_take(context.scene)
        set_lengths(take.armature, Body(Actor(panel_lengths(take.lengths))))
        give_notices(take, "actor", "lengths")
        say(self, "INFO", "The actor has these lengths now; keyframes and pose are kept")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_apply_lengths,))
