"""Bring back an actor that was deleted or replaced."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.messages import label, say
from ..shell.requirements import bones_editable, idle
from ..shell.takes import active_take, find_take, has_lost_actor


def lost_actor(context: bpy.types.Context) -> str | None:
    """The take's actor is gone."""
    take = find_take(context.scene)
    return None if take is not None and has_lost_actor(take) else label("The take's actor is in the scene")


class KEYMARK_OT_restore_actor(BaseOperator, bpy.types.Operator):
    """Put the deleted actor back into the scene, or build it anew, with its keyframes and its motion"""

    bl_idname = "keymark.restore_actor"
    bl_label = "Bring Actor Back"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (lost_actor, bones_editable, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Bring it back."""
        from .restored_actor import restore_actor

        if restore_actor(context, active_take(context.scene)):
            say(self, "INFO", "The actor is built anew; its keyframes and its motion animate it")
        else:
            say(self, "INFO", "The actor is back in the scene, with its keyframes and its motion")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_restore_actor,))
