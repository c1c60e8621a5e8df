"""The characters of a take: which armatures may be one, which is chosen, and what it lacks."""

import bpy

from ...core.errors import InputError
from ...core.retarget.roles import REQUIRED
from ..bridge.actor_bones import is_actor
from ..shell.takes import find_take
from .map_conversion import map_of
from .map_properties import PART_TITLES, PARTS, role_title

MOST_NAMED = 3
"""Roles or bones that a sentence names."""


def may_be_character(candidate: bpy.types.Object | None) -> bool:
    """Whether an object is an armature that is no actor, not even one that has lost bones."""
    if candidate is None or candidate.type != "ARMATURE" or is_actor(candidate):
        return False
    takes = (take for scene in bpy.data.scenes for take in scene.keymark.takes)
    return all(take.armature != candidate for take in takes)


def candidates(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> list[bpy.types.Object]:
    """Armatures of the scene that may be characters and are none of the active take yet.

    The active or a selected one counts alone; else all that are visible.
    """
    take = find_take(scene)
    taken = {character.armature for character in take.characters} if take is not None else set()
    there = [*view_layer.objects, *(each for shown in view_layer.objects for each in _instanced(shown))]
    free = [each for each in dict.fromkeys(there) if may_be_character(each) and each not in taken]
    active = view_layer.objects.active
    selected = [each for each in view_layer.objects.selected if each in free]
    if active in selected:
        return [active]
    hidden = {each for each in view_layer.objects if not each.visible_get(view_layer=view_layer)}
    return selected or [each for each in free if each not in hidden] or free


def _instanced(shown: bpy.types.Object) -> list[bpy.types.Object]:
    """The objects of a collection that an empty shows, as a linked character often stands in a scene."""
    collection = shown.instance_collection if shown.instance_type == "COLLECTION" else None
    return [] if collection is None else list(collection.all_objects)


def active_character(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """Return the character that is chosen in the active take's list.

    Raises:
        InputError: There is none.
    """
    character = find_character(scene)
    if character is None:
        raise InputError(f"scene '{scene.name}' has no character; add one to the take first")
    return character


def find_character(scene: bpy.types.Scene) -> bpy.types.PropertyGroup | None:
    """Return the character that is chosen in the active take's list; None where there is none."""
    take = find_take(scene)
    if take is None or not len(take.characters):
        return None
    return take.characters[min(take.active_character, len(take.characters) - 1)]


def add_character(
    take: bpy.types.PropertyGroup, armature_object: bpy.types.Object | None
) -> bpy.types.PropertyGroup:
    """Add a character to a take and choose it; its bones are recognized where it has an armature."""
    character = take.characters.add()
    take.active_character = len(take.characters) - 1
    if armature_object is not None:
        character.armature = armature_object
    return character


def other_with(
    character: bpy.types.PropertyGroup, armature_object: bpy.types.Object
) -> bpy.types.PropertyGroup | None:
    """Another character of the file, of any take, of the same armature, that has a map."""
    everyone = (
        other for scene in bpy.data.scenes for take in scene.keymark.takes for other in take.characters
    )
    return next(
        (
            other
            for other in everyone
            if other != character and other.armature == armature_object and len(other.character_map.roles)
        ),
        None,
    )


def missing_roles(character: bpy.types.PropertyGroup) -> list[str]:
    """Roles a character cannot do without that have no bone."""
    roles = character.character_map.roles
    return [
        role for role in REQUIRED if role not in roles or not any(entry.bone for entry in roles[role].bones)
    ]


def lost_bones(character: bpy.types.PropertyGroup) -> list[str]:
    """Bones and controls that the map names and the armature does not have, renamed ones for instance."""
    if character.armature is None:
        return []
    there = character.armature.data.bones
    return [name for name in map_of(character.character_map).named_bones if name not in there]


def full_title(role: str) -> str:
    """A role's label with its side, as in a sentence: `left upper arm`."""
    part = next((part for part, roles in PARTS.items() if role in roles and "." in part), None)
    side = f"{PART_TITLES[part].partition(' ')[0]} " if part is not None else ""
    return (side + role_title(role)).lower()


def few(names: list[str]) -> str:
    """The first names of a list, and how many more there are."""
    shown = ", ".join(names[:MOST_NAMED])
    more = len(names) - MOST_NAMED
    return f"{shown} and {more} more" if more > 0 else shown


def shown_result(character: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    """The result that is chosen in a character's list; None where there is none."""
    if not len(character.results):
        return None
    return character.results[min(character.active_result, len(character.results) - 1)]
