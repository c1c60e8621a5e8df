"""Make a library override of a linked character, so that it can be animated here."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.messages import say
from ..shell.requirements import idle
from .characters import active_character, find_character
from .map_conversion import map_of, show_map
from .requirements import armature, is_linked


def linked(context: bpy.types.Context) -> str | None:
    """The chosen character is linked, without an override."""
    unmet = armature(context)
    if unmet is not None:
        return unmet
    return None if is_linked(find_character(context.scene).armature) else "The character is not linked"


class KEYMARK_OT_make_override(BaseOperator, bpy.types.Operator):
    """Make a library override of the linked character, with its meshes, so that it can be animated here"""

    bl_idname = "keymark.make_override"
    bl_label = "Make Override"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (linked, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Override the character and all that belongs to it, and choose the override."""
        character = active_character(context.scene)
        original = character.armature
        instance = _instance_of(context.scene, original)
        overridden = _override(context, original, instance)
        shown = map_of(character.character_map)
        character.armature = overridden
        show_map(character.character_map, shown)
        say(self, "INFO", "'{name}' can be animated now", name=overridden.name)


def _override(
    context: bpy.types.Context, original: bpy.types.Object, instance: bpy.types.Object | None
) -> bpy.types.Object:
    """The override of a linked armature.

    Raises:
        InputError: Blender cannot override it.
    """
    root = original if instance is None else instance.instance_collection
    made = root.override_hierarchy_create(
        context.scene, context.view_layer, reference=instance, do_fully_editable=True
    )
    if made is not None and instance is not None:
        bpy.data.objects.remove(instance)  # the override takes its place
    found = next(
        (
            each
            for each in context.scene.objects
            if each.override_library is not None and each.override_library.reference == original
        ),
        None,
    )
    if found is None:
        raise InputError(
            f"Blender makes no override of '{original.name}'; link its collection instead of the object, "
            "or append it"
        )
    return found


def _instance_of(scene: bpy.types.Scene, original: bpy.types.Object) -> bpy.types.Object | None:
    """The empty of the scene that shows the linked collection an object is in."""
    return next(
        (
            each
            for each in scene.objects
            if each.instance_type == "COLLECTION"
            and each.instance_collection is not None
            and original.name in each.instance_collection.all_objects
        ),
        None,
    )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_make_override,))
