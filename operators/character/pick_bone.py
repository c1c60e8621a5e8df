"""Pick a role's bone by a click on it in the viewport."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.cancel_on_esc import cancel_click
from ..shell.error_reports import reported
from ..shell.footage_clicks import NAVIGATION
from ..shell.requirements import idle
from .bone_under_mouse import bone_under
from .characters import active_character, find_character, full_title
from .requirements import armature
from .role_bone import RoleBoneOperator, active_bone_of, give_bone, told

TAKES_ACTIVE = {"RET", "NUMPAD_ENTER"}


class KEYMARK_OT_pick_bone(RoleBoneOperator, BaseOperator, bpy.types.Operator):
    """Click on the bone in the viewport"""

    bl_idname = "keymark.pick_bone"
    bl_label = "Pick Bone"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (armature, idle)

    bone: bpy.props.StringProperty(name="Bone", description="Name of the bone", options={"SKIP_SAVE"})

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip, which says where the role's bone comes from."""
        known = told(context, properties.role)
        asked = "Click on the bone in the viewport to choose it"
        return f"{known}. {asked}" if known else asked

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Wait for a click on a bone."""
        if self.bone or bpy.app.background:
            return self.execute(context)
        self._ask(context, "")
        context.window_manager.keymark_progress.show("", 0.0)
        context.window.cursor_modal_set("EYEDROPPER")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Name the bone under the mouse, and take the one that is clicked on."""
        if cancel_click(self, context, event):
            return {"CANCELLED"}
        with reported(self):
            return self._watch(context, event)
        self.cancel(context)
        return {"CANCELLED"}

    def _watch(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in TAKES_ACTIVE and event.value == "PRESS":
            return self._take(context, active_bone_of(active_character(context.scene)))
        clicked = event.type == "LEFTMOUSE" and event.value == "PRESS"
        if not clicked and event.type != "MOUSEMOVE":
            return {"PASS_THROUGH"} if event.type in NAVIGATION else {"RUNNING_MODAL"}
        character = find_character(context.scene)
        if character is None or character.armature is None:
            self.cancel(context)
            return {"CANCELLED"}
        under = bone_under(context, character.armature, event.mouse_x, event.mouse_y)
        if not clicked:
            self._ask(context, under or "")
            return {"PASS_THROUGH"}
        return self._take(context, under)

    def _take(self, context: bpy.types.Context, bone: str | None) -> set[str]:
        """Give the bone to the role; wait on where there is none."""
        if bone is None:
            self.report({"WARNING"}, "That is no bone of the character; click on one")
            return {"RUNNING_MODAL"}
        self.bone = bone
        self.cancel(context)
        return self.execute(context)

    def _ask(self, context: bpy.types.Context, under: str) -> None:
        role = full_title(self.role)
        active = active_bone_of(active_character(context.scene))
        if under:
            words = f"{role.capitalize()}: {under}   |   Esc: Cancel"
        elif active is not None:
            words = f"Click on the bone: {role}   |   Enter: {active}, the active one   |   Esc: Cancel"
        else:
            words = f"Click on the bone: {role}   |   Esc: Cancel"
        context.workspace.status_text_set(words)

    def cancel(self, context: bpy.types.Context) -> None:
        """Restore cursor and status bar; Blender calls this as well."""
        if context.window is not None:
            context.window.cursor_modal_restore()
            context.workspace.status_text_set(None)

    def run(self, context: bpy.types.Context) -> None:
        """Give the bone to the role."""
        if not self.bone:
            raise InputError("no bone is chosen; click on one in Pose Mode, or give its name")
        give_bone(active_character(context.scene), self.role, self.index, self.bone)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_pick_bone,))
