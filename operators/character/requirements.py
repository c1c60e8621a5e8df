"""Requirements of the step's operators: what the chosen character lacks, as a tooltip."""

import bpy

from ...core.files.fields import listed
from ..bridge.character.read_character import needs_override
from ..shell.requirements import of_take
from ..shell.take_state import TakeState
from ..shell.takes import active_take
from .characters import (
    MOST_NAMED,
    active_character,
    find_character,
    full_title,
    missing_roles,
    missing_source,
)
from .map_properties import map_of

take = of_take(lambda state: True, "Load the footage or open a take first")


def character(context: bpy.types.Context, _state: TakeState | None) -> str | None:
    """A character is chosen."""
    return None if find_character(context.scene) is not None else "Add a character first"


def armature(context: bpy.types.Context, state: TakeState | None) -> str | None:
    """The chosen character has an armature, in this scene."""
    chosen = find_character(context.scene)
    if chosen is None:
        return character(context, state)
    if chosen.armature is None:
        return "Choose the character's armature first"
    if chosen.armature.type != "ARMATURE":
        return f"'{chosen.armature.name}' is no armature; choose the character's"
    return None


def editable(context: bpy.types.Context, state: TakeState | None) -> str | None:
    """The chosen character is in the scene and can be animated."""
    unmet = armature(context, state)
    if unmet is not None:
        return unmet
    chosen = active_character(context.scene).armature
    if needs_override(chosen):
        return f"'{chosen.name}' is linked; make a library override of it first"
    if chosen.name not in context.scene.objects:
        return f"'{chosen.name}' is not in this scene; add it, or choose another armature"
    return None


def recognized(context: bpy.types.Context, state: TakeState | None) -> str | None:
    """The chosen character's bones have their roles, and are there."""
    unmet = armature(context, state)
    if unmet is not None:
        return unmet
    chosen = active_character(context.scene)
    if not len(chosen.character_map.roles):
        return "Recognize the character's bones first"
    missing = [full_title(role) for role in missing_roles(chosen)]
    if missing:
        return f"Choose the bones of {listed(missing, MOST_NAMED)} first"
    there = chosen.armature.data.bones
    lost = [name for name in map_of(chosen.character_map).named_bones if name not in there]
    if lost:
        bones = listed((f"'{bone}'" for bone in lost), MOST_NAMED)
        said = f"'{chosen.armature.name}' has no bone {bones} any more"
        return f"{said}; recognize its bones again, or choose others"
    return None


def source(context: bpy.types.Context, state: TakeState | None) -> str | None:
    """There is a motion for the character to perform."""
    chosen = find_character(context.scene)
    return character(context, state) if chosen is None else missing_source(active_take(context.scene), chosen)


def result(context: bpy.types.Context, state: TakeState | None) -> str | None:
    """The chosen character has a result."""
    chosen = find_character(context.scene)
    if chosen is None:
        return character(context, state)
    made = any(each.action is not None for each in chosen.results)
    return None if made else "Retarget the motion first"
