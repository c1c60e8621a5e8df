"""Dismiss a notice in the panel of a step."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.takes import active_take


class KEYMARK_OT_dismiss_notice(BaseOperator, bpy.types.Operator):
    """Do not show this sentence any more"""

    bl_idname = "keymark.dismiss_notice"
    bl_label = "Dismiss Notice"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    index: bpy.props.IntProperty(name="Index", description="Number of the take's notice, from 0", min=0)

    def run(self, context: bpy.types.Context) -> None:
        """Remove it."""
        notices = active_take(context.scene).notices
        if self.index >= len(notices):
            raise InputError(
                "index is {index}, but the take has {count} notices",
                index=self.index,
                count=len(notices),
            )
        notices.remove(self.index)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_dismiss_notice,))
