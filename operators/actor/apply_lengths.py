"""Give the actor the lengths in the panel."""

import bpy

from ...core.body.actor import Actor
from ..shell.base_operator import BaseOperator
from ..shell.notices import give_notices
from ..shell.requirements import actor, bones_editable, idle
from ..shell.takes import active_take, find_take, has_lost_actor
from .properties import panel_lengths


def any_actor(context: bpy.types.Context) -> str | None:
    """The take has an actor, or had one."""
    take = find_take(context.scene)
    return None if take is not None and has_lost_actor(take) else actor(context)


class KEYMARK_OT_apply_lengths(BaseOperator, bpy.types.Operator):
    """Give the actor these lengths, or bring a deleted one back; its pose, keyframes and motion stay"""

    bl_idname = "keymark.apply_lengths"
    bl_label = "Apply Lengths"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (any_actor, bones_editable, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Bring back an actor that is gone; resize the bones of one that is there."""
        from ...core.body.kinematics import Body
        from ..bridge.resize import set_lengths
        from .restored_actor import restore_actor

        take = active_take(context.scene)
        if has_lost_actor(take):
            restore_actor(context, take)
            self.report({"INFO"}, "The actor is back, with its keyframes and its motion")
            return
        set_lengths(take.armature, Body(Actor(panel_lengths(take.lengths))))
        give_notices(take, "actor", "lengths")
        self.report({"INFO"}, "The actor has these lengths now; keyframes and pose are kept")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_apply_lengths,))
