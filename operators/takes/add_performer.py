"""Add a take for another performer in the same clip."""

import bpy

from ..shell.requirements import all_met, footage, idle
from ..shell.takes import active_take, add_take


class KEYMARK_OT_add_performer(bpy.types.Operator):
    """Add a take for another performer in the active take's clip, with markers and an actor of their own"""

    bl_idname = "keymark.add_performer"
    bl_label = "Add Performer"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a clip in which they are seen."""
        return all_met(cls, context, footage, idle)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Share clip and camera: what is found of either holds for both performers."""
        scene = context.scene
        source = active_take(scene)
        clip, camera, guessed = source.clip, source.camera, source.guessed_lens_mm
        stem = source.name.partition(" Performer ")[0]
        number = sum(take.clip == clip for take in scene.keymark.takes) + 1
        take = add_take(scene, f"{stem} Performer {number}")  # the source's own place in memory may change
        take.guessed_lens_mm = guessed
        take.camera, take.clip = camera, clip
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_performer,))
