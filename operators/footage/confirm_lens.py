"""Confirm the guessed lens."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.takes import active_take, find_take


def guessed_lens(context: bpy.types.Context) -> str | None:
    """The take's lens is a guess."""
    take = find_take(context.scene)
    return None if take is not None and take.guessed_lens_mm > 0.0 else "The lens is not a guess"


class KEYMARK_OT_keep_lens(BaseOperator, bpy.types.Operator):
    """Confirm that the camera's focal length is right, so that it no longer counts as a guess"""

    bl_idname = "keymark.keep_lens"
    bl_label = "Confirm Lens"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (guessed_lens,)

    def run(self, context: bpy.types.Context) -> None:
        """Clear the guess in every take with this camera."""
        camera = active_take(context.scene).camera
        for take in context.scene.keymark.takes:
            if take.camera == camera:
                take.guessed_lens_mm = 0.0


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_keep_lens,))
