"""Add a character that is to perform the take's motion."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.messages import warn
from ..shell.requirements import idle
from ..shell.takes import active_take
from .characters import add_character, candidates, may_be_character
from .recognition import all_doubts
from .requirements import take


class KEYMARK_OT_add_character(BaseOperator, bpy.types.Operator):
    """Add a character: the selected armature, the only one, or one of several; its bones are recognized"""

    bl_idname = "keymark.add_character"
    bl_label = "Add Character"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (take, idle)

    armature: bpy.props.StringProperty(
        name="Armature",
        description="Name of the armature's object; by default the selected one, or the only one there is",
        options={"SKIP_SAVE"},
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask which, where there are several and none is selected."""
        found = candidates(context.scene, context.view_layer)
        if self.armature or len(found) < 2:
            return self.execute(context)

        names = [each.name for each in found]

        def draw(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
            """Draw an entry for each; Blender has freed the operator by then."""
            for name in names:
                operator = KEYMARK_OT_add_character.bl_idname
                menu.layout.operator(
                    operator, text=name, icon="ARMATURE_DATA", translate=False
                ).armature = name

        context.window_manager.popup_menu(draw, title=self.bl_label)
        return {"CANCELLED"}  # each entry is a step of its own

    def run(self, context: bpy.types.Context) -> None:
        """Add it, and recognize its bones."""
        chosen = self._chosen(context)
        character = add_character(active_take(context.scene), chosen)
        if character.problem:
            warn(self, character.problem)
        elif chosen is None:
            self.report({"INFO"}, "Choose the character's armature")
        elif all_doubts(character):
            self.report({"WARNING"}, f"Check the bones of '{chosen.name}': some are doubtful")
        else:
            self.report({"INFO"}, f"Recognized the bones of '{chosen.name}'")

    def _chosen(self, context: bpy.types.Context) -> bpy.types.Object | None:
        """The armature to add; None where it is left to the person.

        Raises:
            InputError: The armature that was named is not there, or is no character.
        """
        if not self.armature:
            found = candidates(context.scene, context.view_layer)
            return found[0] if len(found) == 1 else None
        named = bpy.data.objects.get(self.armature)
        if not may_be_character(named):
            raise InputError(
                f"'{self.armature}' is no armature of a character in this file; give the name of an "
                "armature's object that is no actor of Keymark's"
            )
        return named


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_character,))
