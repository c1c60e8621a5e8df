"""Remove a take from the scene's list."""

from collections.abc import Iterator

import bpy

from ..shell.requirements import all_met, idle
from ..shell.takes import active_take, find_take

HELPERS = {"CAMERA", "EMPTY"}


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
        own = set(_data_of(take))
        settings.takes.remove(index)
        settings.active_take = max(0, index - 1)
        if self.delete_data:
            others = [other for scene in bpy.data.scenes for other in scene.keymark.takes]
            gone = own.difference(*(_data_of(other) for other in others))
            inner = [block.data for block in gone if isinstance(block, bpy.types.Object)]
            alone = [block for block in inner if block is not None and block.users == 1]
            bpy.data.batch_remove([*gone, *alone])
        return {"FINISHED"}


def _data_of(group: bpy.types.PropertyGroup) -> Iterator[bpy.types.ID]:
    """What a group of properties points to, the groups in it included."""
    for definition in group.bl_rna.properties:
        if definition.type != "POINTER" or definition.identifier == "rna_type":
            continue
        value = getattr(group, definition.identifier)
        if isinstance(value, bpy.types.PropertyGroup):
            yield from _data_of(value)
        elif isinstance(value, bpy.types.ID):
            yield value
            if isinstance(value, bpy.types.Collection):  # of the turntable's cameras and what they hang on
                yield from (each for each in value.objects if each.type in HELPERS)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_take,))
