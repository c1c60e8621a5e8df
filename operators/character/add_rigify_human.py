"""Add a Rigify rig of the performer's size as the character."""

import bpy

from ...core.errors import InputError
from ..bridge.character.rigify_human import add_rigify_human, enable_rigify, has_rigify, is_rigify_enabled
from ..shell.base_operator import BaseOperator
from ..shell.messages import warn
from ..shell.requirements import bones_editable, idle
from ..shell.takes import active_take
from .characters import add_character, find_character
from .requirements import take


def rigify(context: bpy.types.Context) -> str | None:
    """Blender brings Rigify along."""
    return None if has_rigify() else "This Blender comes without the add-on Rigify; install Rigify first"


class KEYMARK_OT_add_rigify_human(BaseOperator, bpy.types.Operator):
    """Add a Rigify rig of the performer's size as the character; asks first where Rigify is not enabled"""

    bl_idname = "keymark.add_rigify_human"
    bl_label = "Add Rigify Human"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (take, rigify, bones_editable, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask before an add-on is enabled, which stays in the preferences."""
        if is_rigify_enabled():
            return self.execute(context)
        return context.window_manager.invoke_confirm(
            self,
            event,
            title="Enable the add-on Rigify?",
            message="It comes with Blender and makes the rig; it stays enabled in the preferences",
            confirm_text="Enable and Add",
        )

    def run(self, context: bpy.types.Context) -> None:
        """Generate the rig, and make it the chosen character where that has no armature yet."""
        active = context.view_layer.objects.active
        if active is not None and active.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            if not is_rigify_enabled():
                enable_rigify()
            rig = add_rigify_human(active_take(context.scene).stature)
        except RuntimeError as error:  # an operator's own error report
            reason = str(error).removeprefix("Error: ").strip()
            raise InputError(
                f"Rigify could not make the rig ({reason}); add one by Add > Armature, and choose it here"
            ) from error
        chosen = find_character(context.scene)
        if chosen is None or chosen.armature is not None:
            chosen = add_character(active_take(context.scene), rig)
        else:
            chosen.armature = rig
        if chosen.problem:
            warn(self, chosen.problem)
        else:
            self.report({"INFO"}, f"Recognized the bones of '{rig.name}'")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_rigify_human,))
