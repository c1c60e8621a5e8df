"""Show one of a character's results on it."""

import bpy

from ...core.errors import InputError
from ..bridge.actions import assign_action
from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle
from .characters import active_character
from .requirements import editable, result


class KEYMARK_OT_show_result(BaseOperator, bpy.types.Operator):
    """Animate the character by this result"""

    bl_idname = "keymark.show_result"
    bl_label = "Show Result"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (result, editable, idle)

    index: bpy.props.IntProperty(name="Index", description="Number of the result in the list, from 0", min=0)

    def run(self, context: bpy.types.Context) -> None:
        """Assign the Action, and choose the result."""
        character = active_character(context.scene)
        if self.index >= len(character.results) or character.results[self.index].action is None:
            raise InputError(f"there is no result number {self.index}; retarget the motion again")
        assign_action(character.armature, character.results[self.index].action)
        character.active_result = self.index


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_show_result,))
