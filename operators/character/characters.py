"""The characters of a take: which armatures may be one, which is chosen, and what it lacks."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import bpy
from bpy.types import Action, Context, Object, PropertyGroup, Scene, ViewLayer

from ...core.errors import MOST_NAMED, InputError
from ...core.files.fields import listed
from ...core.retarget.character import REQUIRED
from ..bridge.actor_bones import is_actor
from ..bridge.character.read_character import needs_override
from ..shell import need
from ..shell.base_operator import capitalized
from ..shell.take_state import TakeState
from ..shell.takes import active_take, find_take
from .map_properties import map_of, role_title


def may_be_character(candidate: Object | None) -> bool:
    """Whether an object is an armature that is no actor, not even one that has lost bones."""
    if candidate is None or candidate.type != "ARMATURE" or is_actor(candidate):
        return False
    return all(take.armature != candidate for scene in bpy.data.scenes for take in scene.keymark.takes)


def require_character_armature(candidate: Object | None, named: str = "") -> None:
    """Raise InputError where an object, of this name, is no armature that may be a character."""
    if not may_be_character(candidate):
        raise InputError(
            f"'{named if candidate is None else candidate.name}' is no armature of a character in this file; "
            "choose an armature that is no actor of Keymark's"
        )


def candidates(scene: Scene, view_layer: ViewLayer) -> list[Object]:
    """Free armatures that may be characters: the active or selected ones alone, else all that are visible."""
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


def active_character(scene: Scene) -> PropertyGroup:
    """Return the character that is chosen in the active take's list.

    Raises:
        InputError: There is none.
    """
    character = find_character(scene)
    if character is None:
        raise InputError(f"scene '{scene.name}' has no character; add one to the take first")
    return character


def find_character(scene: Scene) -> PropertyGroup | None:
    """Return the character that is chosen in the active take's list; None where there is none."""
    take = find_take(scene)
    if take is None or not len(take.characters):
        return None
    return take.characters[min(take.active_character, len(take.characters) - 1)]


def add_character(take: PropertyGroup, armature_object: Object | None) -> PropertyGroup:
    """Add a character to a take and choose it; its bones are recognized where it has an armature."""
    character = take.characters.add()
    take.active_character = len(take.characters) - 1
    if armature_object is not None:
        character.armature = armature_object
    return character


def with_map(armature_object: Object, beside: PropertyGroup | None = None) -> PropertyGroup | None:
    """A character of the file, of any take, of this armature, that has a map; another one than `beside`."""
    takes = (take for scene in bpy.data.scenes for take in scene.keymark.takes)
    characters = (character for take in takes for character in take.characters)
    of_it = (each for each in characters if each.armature == armature_object and each != beside)
    return next((each for each in of_it if len(each.character_map.roles)), None)


def missing_roles(character: PropertyGroup) -> list[str]:
    """Roles a character cannot do without that have no bone."""
    roles = character.character_map.roles
    chosen = {role.name for role in roles if any(entry.bone for entry in role.bones)}
    return [role for role in REQUIRED if role not in chosen]


def full_title(role: str) -> str:
    """A role's label with its side, as in a sentence: `left upper arm`."""
    part, _, side = role.partition(".")
    return {"L": "left ", "R": "right "}.get(side, "") + role_title(part).lower()


def shown_result(character: PropertyGroup) -> PropertyGroup | None:
    """The result that is chosen in a character's list; None where there is none."""
    if not len(character.results):
        return None
    return character.results[min(character.active_result, len(character.results) - 1)]


@dataclass(frozen=True)
class SourceMotion:
    """An Action and the actor it moves."""

    kind: str  # `FINAL`, `MOTION` or `ACTION`
    action: bpy.types.Action
    actor: bpy.types.Object
    title: str  # what a result is named after


def source_of(take: PropertyGroup, character: PropertyGroup) -> SourceMotion:
    """The motion that a character is to perform.

    Raises:
        InputError: There is none; the sentence says what to do.
    """
    kind, action, actor = _source(take, character)
    if (problem := missing_source(take, character)) is not None:
        raise InputError(problem)
    return SourceMotion(kind, action, actor, action.name if kind == "ACTION" else take.name)


def missing_source(take: PropertyGroup, character: PropertyGroup) -> str | None:
    """What is missing for a character to perform, as a sentence; None where nothing is."""
    kind, action, actor = _source(take, character)
    if action is None:
        return {
            "ACTION": "Choose the Action that the character is to perform",
            "FINAL": "Bake the final Action first, or choose another motion",
            "MOTION": "Reconstruct the motion first",
        }[kind]
    if actor is None:
        return "The motion's actor is gone; choose its armature in the step Performer"
    if not is_actor(actor):
        return f"'{actor.name}' is no actor of Keymark's; choose the motion's actor"
    return None


def _source(take: PropertyGroup, character: PropertyGroup) -> tuple[str, Any, Any]:
    kind = str(character.source)
    if kind == "ACTION":
        return kind, character.source_action, character.source_actor or take.armature
    if kind == "NEWEST":
        return *TakeState(take).newest, take.armature
    return kind, take.finish.action if kind == "FINAL" else take.motion_action, take.armature


def result_to_replace(character: PropertyGroup, kind: str, source: Action | None) -> PropertyGroup | None:
    """The result to replace: the chosen one, or else the newest, of the same motion, be it final or not."""
    made = [result for result in character.results if result.action is not None]
    same = [
        result
        for result in made
        if "ACTION" not in (kind, result.source) or (result.source, result.source_action) == (kind, source)
    ]
    chosen = shown_result(character)
    return chosen if chosen in same else next(reversed(same), None)


def add_result(character: PropertyGroup, source: SourceMotion, action: Action, digest: str) -> PropertyGroup:
    """List and choose an Action, in place of what was of it, with its source's digest; deleted ones go."""
    for index in reversed(range(len(character.results))):
        if character.results[index].action is None:
            character.results.remove(index)
    actions = [each.action for each in character.results]
    index = actions.index(action) if action in actions else len(actions)
    result = character.results[index] if index < len(actions) else character.results.add()
    result.action, result.made_from, result.armature = action, digest, character.armature
    result.source, result.source_action, result.source_actor = source.kind, source.action, source.actor
    character.active_result = index
    return result


def add_lines(lines: bpy.types.bpy_prop_collection_idprop, sentences: Iterable[str], level: str) -> None:
    """Add sentences to a list that the panel shows."""
    for sentence in sentences:
        line = lines.add()
        line.text, line.level = capitalized(sentence), level


# --- Requirements of the step's operators: what the chosen character lacks, as a tooltip


take = need.of_take(lambda state: True, "Load the footage or open a take first")


character = need.of_take(lambda state: len(state.take.characters), "Add a character first")


def armature(context: Context, _state: TakeState | None) -> str | None:
    """The chosen character has an armature, in this scene."""
    chosen = find_character(context.scene)
    if chosen is None:
        return "Add a character first"
    if chosen.armature is None:
        return "Choose the character's armature first"
    if chosen.armature.type != "ARMATURE":
        return f"'{chosen.armature.name}' is no armature; choose the character's"
    return None


def editable(context: Context, _state: TakeState | None) -> str | None:
    """The chosen character, which has an armature, is in the scene and can be animated."""
    chosen = active_character(context.scene).armature
    if needs_override(chosen):
        return f"'{chosen.name}' is linked; make a library override of it first"
    if chosen.name not in context.scene.objects:
        return f"'{chosen.name}' is not in this scene; add it, or choose another armature"
    return None


def recognized(context: Context, _state: TakeState | None) -> str | None:
    """The bones of the chosen character, which has an armature, have their roles, and are there."""
    chosen = active_character(context.scene)
    if not len(chosen.character_map.roles):
        return "Recognize the character's bones first"
    missing = [full_title(role) for role in missing_roles(chosen)]
    if missing:
        return f"Choose the bones of {listed(missing, MOST_NAMED)} first"
    there = chosen.armature.data.bones
    lost = [f"'{name}'" for name in map_of(chosen.character_map).named_bones if name not in there]
    if not lost:
        return None
    lacking = f"'{chosen.armature.name}' has no bone {listed(lost, MOST_NAMED)} any more"
    return f"{lacking}; recognize its bones again, or choose others"


def source(context: Context, _state: TakeState | None) -> str | None:
    """There is a motion for the chosen character to perform."""
    return missing_source(active_take(context.scene), active_character(context.scene))


def result(context: Context, _state: TakeState | None) -> str | None:
    """The chosen character has a result."""
    made = any(each.action is not None for each in active_character(context.scene).results)
    return None if made else "Retarget the motion first"
