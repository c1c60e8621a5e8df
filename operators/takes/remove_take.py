"""Remove a take from the scene's list."""

from collections.abc import Iterator

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle
from ..shell.takes import active_take, find_take


def take(context: bpy.types.Context) -> str | None:
    """The scene has a take."""
    return "There is no take to remove" if find_take(context.scene) is None else None


class KEYMARK_OT_remove_take(BaseOperator, bpy.types.Operator):
    """Remove the active take from the list; its clip, camera, actor and Actions stay, unless deleted too"""

    bl_idname = "keymark.remove_take"
    bl_label = "Remove Take"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (take, idle)

    delete_data: bpy.props.BoolProperty(
        name="Delete Its Data",
        description="Delete its actor, camera, clip and Actions too, its characters' included, except what "
        "another take uses; the characters stay",
        default=False,
        options={"SKIP_SAVE"},
    )

    def run(self, context: bpy.types.Context) -> None:
        """Remove the take; the one before it becomes active."""
        settings = context.scene.keymark
        active = active_take(context.scene)
        index = next(i for i, each in enumerate(settings.takes) if each == active)
        own = set(_all_data_of(active))
        settings.takes.remove(index)
        settings.active_take = max(0, index - 1)
        if self.delete_data:
            others = [other for scene in bpy.data.scenes for other in scene.keymark.takes]
            deleted = own.difference(*(_all_data_of(other) for other in others))
            inner = [block.data for block in deleted if isinstance(block, bpy.types.Object)]
            alone = [block for block in inner if block is not None and block.users == 1]
            bpy.data.batch_remove([*deleted, *alone])


def _all_data_of(take: bpy.types.PropertyGroup) -> Iterator[bpy.types.ID]:
    """Yield a take's data-blocks, and the Actions that its characters got; not the characters themselves."""
    yield from _data_of(take)
    for character in take.characters:
        yield from (result.action for result in character.results if result.action is not None)


def _data_of(group: bpy.types.PropertyGroup) -> Iterator[bpy.types.ID]:
    """Yield the data-blocks that a group of properties points to, nested groups included."""
    for definition in group.bl_rna.properties:
        if definition.type != "POINTER" or definition.identifier == "rna_type":
            continue
        value = getattr(group, definition.identifier)
        if isinstance(value, bpy.types.PropertyGroup):
            yield from _data_of(value)
        elif isinstance(value, bpy.types.ID):
            yield value


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_take,))
