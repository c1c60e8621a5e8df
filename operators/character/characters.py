"""The characters of a take: which armatures may be one, which is chosen, and what it lacks."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import bpy

from ...core.errors import InputError
from ...core.retarget.character import REQUIRED
from ..bridge.actor_bones import is_actor
from ..shell.base_operator import capitalized
from ..shell.take_state import TakeState
from ..shell.takes import find_take
from .map_properties import role_title

MOST_NAMED = 3  # roles or bones that a sentence names


def may_be_character(candidate: bpy.types.Object | None) -> bool:
    """Whether an object is an armature that is no actor, not even one that has lost bones."""
    if candidate is None or candidate.type != "ARMATURE" or is_actor(candidate):
        return False
    return all(take.armature != candidate for take in _takes())


def require_character_armature(candidate: bpy.types.Object | None, named: str = "") -> None:
    """Raise InputError where an object, of this name, is no armature that may be a character."""
    if not may_be_character(candidate):
        raise InputError(
            f"'{named if candidate is None else candidate.name}' is no armature of a character in this file; "
            "choose an armature that is no actor of Keymark's"
        )


def _takes() -> Iterator[bpy.types.PropertyGroup]:
    return (take for scene in bpy.data.scenes for take in scene.keymark.takes)


def candidates(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> list[bpy.types.Object]:
    """Armatures of the scene that may be characters and are none of the active take yet.

    The active or a selected one counts alone; else all that are visible.
    """
    take = find_take(scene)
    taken = {character.armature for character in take.characters} if take is not None else set()
    there = list(view_layer.objects)
    for shown in view_layer.objects:  # a linked character often stands in a scene as an empty
        if shown.instance_type == "COLLECTION" and shown.instance_collection is not None:
            there += shown.instance_collection.all_objects
    free = [each for each in dict.fromkeys(there) if may_be_character(each) and each not in taken]
    active = view_layer.objects.active
    selected = [each for each in view_layer.objects.selected if each in free]
    if active in selected:
        return [active]
    hidden = {each for each in view_layer.objects if not each.visible_get(view_layer=view_layer)}
    return selected or [each for each in free if each not in hidden] or free


def active_character(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """Return the character that is chosen in the active take's list. InputError: there is none."""
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


def with_map(
    armature_object: bpy.types.Object, beside: bpy.types.PropertyGroup | None = None
) -> bpy.types.PropertyGroup | None:
    """A character of the file, of any take, of this armature, that has a map; another one than `beside`."""
    characters = (character for take in _takes() for character in take.characters)
    of_it = (each for each in characters if each.armature == armature_object and each != beside)
    return next((each for each in of_it if len(each.character_map.roles)), None)


def missing_roles(character: bpy.types.PropertyGroup) -> list[str]:
    """Roles a character cannot do without that have no bone."""
    roles = character.character_map.roles
    chosen = {role.name for role in roles if any(entry.bone for entry in role.bones)}
    return [role for role in REQUIRED if role not in chosen]


def full_title(role: str) -> str:
    """A role's label with its side, as in a sentence: `left upper arm`."""
    side = {"L": "left ", "R": "right "}.get(role.partition(".")[2], "")
    return side + role_title(role).lower()


def shown_result(character: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    """The result that is chosen in a character's list; None where there is none."""
    if not len(character.results):
        return None
    return character.results[min(character.active_result, len(character.results) - 1)]


# --- The motion that a character performs


@dataclass(frozen=True)
class SourceMotion:
    """An Action and the actor it moves."""

    kind: str  # `FINAL`, `MOTION` or `ACTION`
    action: bpy.types.Action
    actor: bpy.types.Object
    title: str  # what a result is named after


def source_of(take: bpy.types.PropertyGroup, character: bpy.types.PropertyGroup) -> SourceMotion:
    """The motion that a character is to perform. InputError: there is none; the sentence says what to do."""
    problem = missing_source(take, character)
    if problem is not None:
        raise InputError(problem)
    kind, action, actor = _source(take, character)
    return SourceMotion(kind, action, actor, action.name if kind == "ACTION" else take.name)


def missing_source(take: bpy.types.PropertyGroup, character: bpy.types.PropertyGroup) -> str | None:
    """What is missing for a character to perform, as a sentence; None where nothing is."""
    kind, action, actor = _source(take, character)
    if action is None:
        return LACKING[kind]
    if actor is None:
        return "The motion's actor is gone; choose its armature in the step Performer"
    if not is_actor(actor):
        return f"'{actor.name}' is no actor of Keymark's; choose the motion's actor"
    return None


LACKING = {
    "ACTION": "Choose the Action that the character is to perform",
    "FINAL": "Bake the final Action first, or choose another motion",
    "MOTION": "Reconstruct the motion first",
}
"""What is to be done where there is no motion of a kind."""


def _source(take: bpy.types.PropertyGroup, character: bpy.types.PropertyGroup) -> tuple[str, Any, Any]:
    """The kind of motion that a character is to perform, its Action, and the actor that this moves."""
    kind = str(character.source)
    if kind == "ACTION":
        return kind, character.source_action, character.source_actor or take.armature
    if kind == "NEWEST":
        return *TakeState(take).newest, take.armature
    return kind, take.finish.action if kind == "FINAL" else take.motion_action, take.armature


# --- Results of retargeting, in a character's list


OF_THE_TAKE = ("FINAL", "MOTION")


def result_to_replace(
    character: bpy.types.PropertyGroup, kind: str, source_action: bpy.types.Action | None
) -> bpy.types.PropertyGroup | None:
    """The result that retargeting again replaces: the chosen one, or else the newest, of the same motion.

    The take's final and its reconstructed motion are one motion; any other Action is one of its own.
    """
    same = [
        result
        for result in character.results
        if result.action is not None
        and (
            (kind in OF_THE_TAKE and result.source in OF_THE_TAKE)
            or (result.source == kind and result.source_action == source_action)
        )
    ]
    chosen = shown_result(character)
    return chosen if chosen in same else next(reversed(same), None)


def add_result(
    character: bpy.types.PropertyGroup, source: SourceMotion, action: bpy.types.Action, made_from: str
) -> bpy.types.PropertyGroup:
    """List an Action as a result, in place of what was listed of it, and choose it; deleted ones go.

    `made_from` is the digest of the source's curves.
    """
    for empty in reversed([i for i, each in enumerate(character.results) if each.action is None]):
        character.results.remove(empty)
    index = next((i for i, each in enumerate(character.results) if each.action == action), None)
    if index is None:
        index = len(character.results)
        character.results.add()
    result = character.results[index]
    result.action, result.made_from, result.armature = action, made_from, character.armature
    result.source, result.source_action, result.source_actor = source.kind, source.action, source.actor
    character.active_result = index
    return result


def drop_results_of_others(character: bpy.types.PropertyGroup) -> None:
    """Take results that move another armature than the chosen one out of the list; their Actions stay."""
    others = [i for i, each in enumerate(character.results) if each.armature != character.armature]
    for index in reversed(others):
        character.results.remove(index)
    character.active_result = max(0, len(character.results) - 1)


def add_lines(lines: "bpy.types.bpy_prop_collection_idprop", sentences: Iterable[str], level: str) -> None:
    """Add sentences to a list that the panel shows."""
    for sentence in sentences:
        line = lines.add()
        line.text, line.level = capitalized(sentence), level


def is_shown(character: bpy.types.PropertyGroup, result: bpy.types.PropertyGroup) -> bool:
    """Whether a result animates its character now."""
    data = character.armature.animation_data if character.armature is not None else None
    return data is not None and data.action is not None and data.action == result.action
