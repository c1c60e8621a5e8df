"""Add a character that is to perform the take's motion."""

import bpy
from bpy.types import Context, Event, Menu, Operator, PropertyGroup

from ...core.errors import InputError
from ..actor.take_actor import leave_mode
from ..bridge.character.read_character import make_override, needs_override
from ..bridge.character.rigify_human import add_rigify_human, enable_rigify, has_rigify, is_rigify_enabled
from ..shell import need
from ..shell.base_operator import BaseOperator, operator, remove_active
from ..shell.fields import SKIP_SAVE, Text
from ..shell.takes import active_take
from . import characters
from .map_properties import map_of, show_map
from .recognition import say_recognized


class KEYMARK_OT_add_character(BaseOperator, bpy.types.Operator):
    """Add a character: the selected armature, the only one, or one of several; its bones are recognized"""

    bl_label = "Add Character"
    requirements = (characters.take, need.idle)

    armature: Text(
        "Armature",
        "Name of the armature's object; by default the selected one, or the only one there is",
        options=SKIP_SAVE,
    )

    def invoke(self, context: Context, event: Event) -> set[str]:
        found = characters.candidates(context.scene, context.view_layer)
        if self.armature or len(found) < 2:
            return self.execute(context)
        names, own = [each.name for each in found], "keymark.add_character"

        def draw(menu: Menu, _context: Context) -> None:
            for name in names:  # Blender has freed the operator by then
                entry = menu.layout.operator(own, text=name, icon="ARMATURE_DATA", translate=False)
                entry.armature = name

        context.window_manager.popup_menu(draw, title=self.bl_label)
        return {"CANCELLED"}  # each entry is a step of its own

    def run(self, context: Context) -> None:
        if self.armature:
            chosen = bpy.data.objects.get(self.armature)
            characters.require_character_armature(chosen, self.armature)
        else:
            found = characters.candidates(context.scene, context.view_layer)
            chosen = found[0] if len(found) == 1 else None
        character = characters.add_character(active_take(context.scene), chosen)
        if chosen is None:
            self.report({"INFO"}, "Choose the character's armature")
        else:
            say_recognized(self, character)


rigify = need.of_take(
    lambda _state: has_rigify(), "This Blender comes without the add-on Rigify; install Rigify first"
)


def add_rigify_character(context: Context) -> PropertyGroup:
    """Add a Rigify rig of the performer's size; enables Rigify.

    Raises:
        InputError: It cannot make one.
    """
    leave_mode(context)
    try:
        if not is_rigify_enabled():
            enable_rigify()
        rig = add_rigify_human(active_take(context.scene).stature)
    except RuntimeError as error:  # an operator's own error report
        reason = str(error).removeprefix("Error: ").strip()
        raise InputError(
            f"Rigify could not make the rig ({reason}); add one by Add > Armature, and choose it here"
        ) from error
    chosen = characters.find_character(context.scene)
    if chosen is None or chosen.armature is not None:
        return characters.add_character(active_take(context.scene), rig)
    chosen.armature = rig
    return chosen


class KEYMARK_OT_add_rigify_human(BaseOperator, bpy.types.Operator):
    """Add a Rigify rig of the performer's size as the character; asks first where Rigify is not enabled"""

    bl_label = "Add Rigify Human"
    requirements = (characters.take, rigify, need.bones_editable, need.idle)

    def invoke(self, context: Context, event: Event) -> set[str]:
        if is_rigify_enabled():
            return self.execute(context)
        return context.window_manager.invoke_confirm(
            self,
            event,
            title="Enable the add-on Rigify?",
            message="It comes with Blender and makes the rig; it stays enabled in the preferences",
            confirm_text="Enable and Add",
        )

    def run(self, context: Context) -> None:
        say_recognized(self, add_rigify_character(context))


@operator("Remove Character", characters.character, need.idle)
def remove_character(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Remove the chosen character from the list; its armature and Actions stay"""
    remove_active(active_take(context.scene), "characters", "active_character")


linked = need.of_take(
    lambda state: needs_override(characters.active_character(state.take.id_data).armature),
    "The character is not linked",
)


class KEYMARK_OT_make_override(BaseOperator, bpy.types.Operator):
    """Make a library override of the linked character, with its meshes, so that it can be animated here"""

    bl_label = "Make Override"
    requirements = (characters.armature, linked, need.idle)

    def run(self, context: Context) -> None:
        character = characters.active_character(context.scene)
        original, scene = character.armature, context.scene
        # A linked collection often stands in a scene as an empty, in whose place it is overridden.
        empties = [] if original.name in scene.objects else scene.objects
        holders = ((one, one.instance_collection) for one in empties if one.instance_type == "COLLECTION")
        holds = (pair for pair in holders if pair[1] and original in pair[1].all_objects[:])
        instance, collection = next(holds, (None, None))
        if collection is None:
            overridden = make_override(context, original)
        else:
            made = collection.override_hierarchy_create(
                scene, context.view_layer, reference=instance, do_fully_editable=True
            )
            overrides = (one for one in scene.objects if one.override_library is not None)
            overridden = next((one for one in overrides if one.override_library.reference == original), None)
            if made is None or overridden is None:
                raise InputError(
                    f"Blender makes no library override of collection '{collection.name}', which holds "
                    f"'{original.name}'; append it instead"
                )
        known = map_of(character.character_map)
        character.armature = overridden
        if known.roles:
            show_map(character.character_map, known)
        self.report({"INFO"}, f"'{overridden.name}' can be animated now")
