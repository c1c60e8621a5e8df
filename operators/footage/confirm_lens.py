"""Say that the guessed lens is right."""

import bpy

from ..shell.takes import active_take, find_take


class KEYMARK_OT_keep_lens(bpy.types.Operator):
    """Say that the camera's focal length is right, so that it no longer counts as a guess"""

    bl_idname = "keymark.keep_lens"
    bl_label = "Keep Lens"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """It must be a guess."""
        take = find_take(context.scene)
        if take is not None and take.guessed_lens_mm > 0.0:
            return True
        cls.poll_message_set("The lens is not a guess")
        return False

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Forget that it was guessed, for every take with this camera."""
        camera = active_take(context.scene).camera
        for take in context.scene.keymark.takes:
            if take.camera == camera:
                take.guessed_lens_mm = 0.0
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_keep_lens,))
