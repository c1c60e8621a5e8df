"""Remove a character from a take's list."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle
from ..shell.takes import active_take
from .requirements import character


class KEYMARK_OT_remove_character(BaseOperator, bpy.types.Operator):
    """Remove the chosen character from the list; its armature and Actions stay"""

    bl_idname = "keymark.remove_character"
    bl_label = "Remove Character"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (character, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Remove it; the one before it is chosen."""
        take = active_take(context.scene)
        index = min(take.active_character, len(take.characters) - 1)
        take.characters.remove(index)
        take.active_character = max(0, index - 1)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_character,))
