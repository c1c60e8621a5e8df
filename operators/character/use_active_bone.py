"""Give a role the active bone."""

import bpy

from ..shell.base_operator import BaseOperator
from .characters import active_character
from .requirements import active_bone
from .role_bone import RoleBoneOperator, active_bone_of, give_bone


class KEYMARK_OT_use_active_bone(RoleBoneOperator, BaseOperator, bpy.types.Operator):
    """Take the active bone of the character, as clicked on in Pose Mode"""

    bl_idname = "keymark.use_active_bone"
    bl_label = "Use Active Bone"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (active_bone,)

    def run(self, context: bpy.types.Context) -> None:
        """Give it to the role."""
        character = active_character(context.scene)
        give_bone(character, self.role, self.index, active_bone_of(character) or "")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_use_active_bone,))
