"""Confirm the place of the camera that was guessed."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.placement_guess import placement_is_guess
from ..shell.takes import active_take, find_take
from .camera_fields import confirm_placement


def guessed_placement(context: bpy.types.Context) -> str | None:
    """The camera's placement is a guess."""
    take = find_take(context.scene)
    return None if take is not None and placement_is_guess(take) else "The camera's place is not a guess"


class KEYMARK_OT_keep_camera(BaseOperator, bpy.types.Operator):
    """Confirm the height and the tilt of the camera, so that they no longer count as a guess"""

    bl_idname = "keymark.keep_camera"
    bl_label = "Confirm Camera"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (guessed_placement,)

    def run(self, context: bpy.types.Context) -> None:
        """Clear the guess in every take with this camera."""
        confirm_placement(active_take(context.scene))


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_keep_camera,))
