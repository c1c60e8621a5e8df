"""Add a take for another performer in the same clip."""

import bpy

from ..keypoints.keypoint_paths import add_keypoint_file, keypoint_path
from ..shell.base_operator import BaseOperator
from ..shell.requirements import footage, idle
from ..shell.takes import active_take, add_take


class KEYMARK_OT_add_performer(BaseOperator, bpy.types.Operator):
    """Add a take for another performer in the active take's clip, with an actor and markers of their own"""

    bl_idname = "keymark.add_performer"
    bl_label = "Add Performer"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Add a take that shares clip, camera, guesses and keypoint files with the active one."""
        scene = context.scene
        source = active_take(scene)
        clip, camera, guessed = source.clip, source.camera, source.guessed_lens_mm
        placement = tuple(source.guessed_placement)
        files = [keypoint_path(entry) for entry in source.follow.files]
        stem = source.name.partition(" Performer ")[0]
        number = sum(take.clip == clip for take in scene.keymark.takes) + 1
        take = add_take(scene, f"{stem} Performer {number}")  # may move `source` in memory
        take.guessed_lens_mm, take.guessed_placement = guessed, placement
        take.camera, take.clip = camera, clip
        for path in files:
            add_keypoint_file(take, path)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_performer,))
