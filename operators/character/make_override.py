"""Make a library override of a linked character, so that it can be animated here."""

import bpy

from ...core.errors import InputError
from ..bridge.character.read_character import make_override, needs_override
from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle
from .characters import active_character
from .map_conversion import map_of, show_map
from .requirements import armature


def linked(context: bpy.types.Context) -> str | None:
    """The chosen character is linked, without an override."""
    unmet = armature(context)
    if unmet is not None:
        return unmet
    return None if needs_override(active_character(context.scene).armature) else "The character is not linked"


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
        if instance is not None:
            overridden = _override_instance(context, original, instance)
        else:
            overridden = make_override(context, original)
        known = map_of(character.character_map)
        character.armature = overridden
        if known.roles:
            show_map(character.character_map, known)
        self.report({"INFO"}, f"'{overridden.name}' can be animated now")


def _override_instance(
    context: bpy.types.Context, original: bpy.types.Object, instance: bpy.types.Object
) -> bpy.types.Object:
    """Override a linked collection in place of the empty that shows it; returns the armature's override.

    Raises:
        InputError: Blender refuses.
    """
    collection = instance.instance_collection
    made = collection.override_hierarchy_create(
        context.scene, context.view_layer, reference=instance, do_fully_editable=True
    )
    overrides = (each for each in context.scene.objects if each.override_library is not None)
    found = next((each for each in overrides if each.override_library.reference == original), None)
    if made is None or found is None:
        raise InputError(
            f"Blender makes no library override of collection '{collection.name}', which holds "
            f"'{original.name}'; append it instead"
        )
    return found


def _instance_of(scene: bpy.types.Scene, original: bpy.types.Object) -> bpy.types.Object | None:
    """The empty of the scene that shows the linked collection an object is in; None where there is none."""
    if original.name in scene.objects:
        return None
    return next(
        (
            each
            for each in scene.objects
            if each.instance_type == "COLLECTION"
            and each.instance_collection is not None
            and original in each.instance_collection.all_objects[:]
        ),
        None,
    )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_make_override,))
