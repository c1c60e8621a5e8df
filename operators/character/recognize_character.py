"""Recognize a character's bones."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.messages import warn
from ..shell.requirements import idle
from .characters import active_character
from .recognition import all_doubts, recognize_bones
from .requirements import armature


class KEYMARK_OT_recognize_character(BaseOperator, bpy.types.Operator):
    """Find out which bones play which role, by their names and places; replaces what you chose before"""

    bl_idname = "keymark.recognize_character"
    bl_label = "Recognize"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (armature, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Recognize the bones, and show them."""
        character = active_character(context.scene)
        recognize_bones(character)
        doubts = all_doubts(character)
        for doubt in doubts:
            warn(self, doubt)
        if doubts:
            return
        self.report({"INFO"}, f"Recognized the bones of '{character.armature.name}'")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_recognize_character,))
