"""Add a take for another performer in the same clip."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.requirements import footage, idle
from ..shell.takes import active_take, add_take


class KEYMARK_OT_add_performer(BaseOperator, bpy.types.Operator):
    """Add a take for another performer in the active take's clip, with markers and an actor of their own"""

    bl_idname = "keymark.add_performer"
    bl_label = "Add Performer"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Add a take that shares clip, camera and guessed lens with the active one."""
        scene = context.scene
        source = active_take(scene)
        clip, camera, guessed = source.clip, source.camera, source.guessed_lens_mm
        stem = source.name.partition(" Performer ")[0]
        number = sum(take.clip == clip for take in scene.keymark.takes) + 1
        take = add_take(scene, f"{stem} Performer {number}")  # may move `source` in memory
        take.guessed_lens_mm = guessed
        take.camera, take.clip = camera, clip


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_performer,))
