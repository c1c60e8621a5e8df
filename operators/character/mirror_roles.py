"""Copy the roles of one side to the other."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle
from .characters import active_character, few, full_title
from .map_conversion import map_of, show_map
from .requirements import armature

SIDES = (
    ("L", "Left to Right", "Copy the bones of the left arm and leg to the right"),
    ("R", "Right to Left", "Copy the bones of the right arm and leg to the left"),
)


class KEYMARK_OT_mirror_roles(BaseOperator, bpy.types.Operator):
    """Copy the bones and controls of one side's arm and leg to the other, by mirrored names and places"""

    bl_idname = "keymark.mirror_roles"
    bl_label = "Mirror"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (armature, idle)

    side: bpy.props.EnumProperty(name="Direction", description="Which side is copied", items=SIDES)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Find the partner of every bone of the side."""
        from ...core.retarget.maps.mirroring import mirrored_map
        from ..bridge.character.read_character import read_character

        character = active_character(context.scene)
        before = map_of(character.character_map)
        after, missing = mirrored_map(read_character(character.armature), before, self.side)
        if missing:
            names = few([full_title(role) for role in missing])
            self.report({"WARNING"}, f"No bones were found that mirror those for {names}")
        if after == before:
            return {"CANCELLED"}
        doubts = {
            role.name: role.doubt
            for role in character.character_map.roles
            if role.doubt and after.roles.get(role.name) == before.roles.get(role.name)
        }
        show_map(character.character_map, after, doubts)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_mirror_roles,))
