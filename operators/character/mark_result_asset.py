"""Mark a character's result as an asset, with the details that the actor's has."""

import bpy

from ...core.errors import InputError
from ..finish.asset_details import mark_motion_asset
from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle
from ..shell.takes import active_take
from .characters import active_character, shown_result
from .requirements import result


class KEYMARK_OT_mark_result_asset(BaseOperator, bpy.types.Operator):
    """Mark the character's motion as an asset, with the catalog, tags and details in the step Finish"""

    bl_idname = "keymark.mark_result_asset"
    bl_label = "Mark Asset"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (result, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Mark the Action; its picture is the performer's, who moves alike."""
        take, made = active_take(context.scene), shown_result(active_character(context.scene))
        if made is None or made.action is None:
            raise InputError("the result's Action has been deleted; retarget the motion again")
        mark_motion_asset(context, take, made.action, made.source_action, made.source_actor)
        if made.outdated:
            self.report(
                {"WARNING"}, "The character's motion is of an earlier one; retarget it for the newest"
            )
        self.report({"INFO"}, f"'{made.action.name}' is an asset now; save the .blend to keep it")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_mark_result_asset,))
