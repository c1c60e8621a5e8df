"""Remove a take from the scene's list."""

import bpy

from .requirements import all_met, idle
from .takes import active_take, find_take

OWNED = ("armature", "camera", "clip", "keyframe_action", "motion_action")
"""What a take points to."""


class KEYMARK_OT_remove_take(bpy.types.Operator):
    """Take the active take from the list; its clip, camera, actor and Actions stay unless said otherwise"""

    bl_idname = "keymark.remove_take"
    bl_label = "Remove Take"
    bl_options = {"REGISTER", "UNDO"}

    delete_data: bpy.props.BoolProperty(
        name="Delete Its Data",
        description="Delete its actor, Actions, camera and clip too, but for what another take uses",
        default=False,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be one, and no job at work on it."""
        if find_take(context.scene) is None:
            cls.poll_message_set("There is no take to remove")
            return False
        return all_met(cls, context, idle)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove it; the one before becomes active."""
        settings = context.scene.keymark
        take = active_take(context.scene)
        index = next(i for i, each in enumerate(settings.takes) if each == take)
        own = [getattr(take, name) for name in OWNED]
        settings.takes.remove(index)
        settings.active_take = max(0, index - 1)
        if self.delete_data:
            used = {
                getattr(other, name)
                for scene in bpy.data.scenes
                for other in scene.keymark.takes
                for name in OWNED
            }
            gone = [block for block in own if block is not None and block not in used]
            data = [block.data for block in gone if isinstance(block, bpy.types.Object)]
            alone = [block for block in data if block is not None and block.users == 1]
            bpy.data.batch_remove([*gone, *alone])
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_take,))
