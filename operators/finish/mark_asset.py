"""Mark a take's motion as an asset."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.messages import warn_if_outdated
from ..shell.requirements import actor, idle, motion
from ..shell.takes import active_take
from .asset_details import mark_motion_asset


class KEYMARK_OT_mark_asset(BaseOperator, bpy.types.Operator):
    """Mark the motion, the final Action if there is one, as an asset with catalog, tags and picture"""

    bl_idname = "keymark.mark_asset"
    bl_label = "Mark Asset"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, motion, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Mark the Action, with the details in the panel."""
        take = active_take(context.scene)
        action = take.finish.action or take.motion_action
        mark_motion_asset(context, take, action, action)
        warn_if_outdated(self, take)
        self.report({"INFO"}, f"'{action.name}' is an asset now; save the .blend to keep it")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_mark_asset,))
