"""Add a bone to a chain, or take one away."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from .characters import active_character
from .map_conversion import role_named
from .requirements import armature
from .role_bone import RoleBoneOperator, chain_role


class KEYMARK_OT_add_chain_bone(RoleBoneOperator, BaseOperator, bpy.types.Operator):
    """Add the next bone upward to the chain"""

    bl_idname = "keymark.add_chain_bone"
    bl_label = "Add Bone"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (armature,)

    def run(self, context: bpy.types.Context) -> None:
        """Add the bone that continues the last one; an empty field where none does."""
        character = active_character(context.scene)
        shown = role_named(character.character_map, chain_role(self.role))
        taken = {entry.bone for role in character.character_map.roles for entry in role.bones}
        last = shown.bones[-1].bone if len(shown.bones) else ""
        shown.bones.add().bone = _next_upward(character.armature.data.bones, last, taken)


class KEYMARK_OT_remove_chain_bone(RoleBoneOperator, BaseOperator, bpy.types.Operator):
    """Take this bone out of the chain; its turn goes to the others"""

    bl_idname = "keymark.remove_chain_bone"
    bl_label = "Remove Bone"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (armature,)

    def run(self, context: bpy.types.Context) -> None:
        """Remove it; a chain without bones keeps an empty field."""
        shown = role_named(active_character(context.scene).character_map, chain_role(self.role))
        if self.index >= len(shown.bones):
            raise InputError(
                f"the role {self.role} has {len(shown.bones)} bones; there is no number {self.index}"
            )
        if len(shown.bones) == 1:
            shown.bones[0].bone = ""
            return
        shown.bones.remove(self.index)
        shown.source, shown.confidence, shown.doubt, shown.uneven = "you", 1.0, "", False


def _next_upward(bones: "bpy.types.bpy_prop_collection[bpy.types.Bone]", last: str, taken: set[str]) -> str:
    """The child that goes on from a bone's tail and plays no role yet; empty where there is none."""
    below = bones.get(last)
    free = [child for child in below.children if child.name not in taken] if below is not None else []
    nearest = min(free, key=lambda child: (child.head_local - below.tail_local).length, default=None)
    return nearest.name if nearest is not None else ""


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_OT_add_chain_bone, KEYMARK_OT_remove_chain_bone)
)
