"""Remove a result from a character's list."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle
from .characters import active_character
from .requirements import character


class KEYMARK_OT_remove_result(BaseOperator, bpy.types.Operator):
    """Remove this result from the list; its Action stays in the file, for you to delete"""

    bl_idname = "keymark.remove_result"
    bl_label = "Remove Result"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (character, idle)

    index: bpy.props.IntProperty(name="Index", description="Number of the result in the list, from 0", min=0)

    def run(self, context: bpy.types.Context) -> None:
        """Remove it."""
        chosen = active_character(context.scene)
        if self.index >= len(chosen.results):
            raise InputError(
                f"there is no result number {self.index}; the character has {len(chosen.results)}"
            )
        chosen.results.remove(self.index)
        chosen.active_result = max(0, min(chosen.active_result, len(chosen.results) - 1))


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_result,))
