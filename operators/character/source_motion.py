"""The motion that a character performs: an Action, and the actor that it moves."""

from dataclasses import dataclass

import bpy

from ...core.errors import InputError
from ..bridge.actor_bones import is_actor


@dataclass(frozen=True)
class SourceMotion:
    """An Action and the actor it moves."""

    kind: str
    """`FINAL`, `MOTION` or `ACTION`."""
    action: bpy.types.Action
    actor: bpy.types.Object
    title: str
    """What a result is named after."""


def source_of(take: bpy.types.PropertyGroup, character: bpy.types.PropertyGroup) -> SourceMotion:
    """The motion that a character is to perform.

    Raises:
        InputError: There is none; the sentence says what to do.
    """
    problem = missing_source(take, character)
    if problem is not None:
        raise InputError(problem)
    kind = _kind(take, character)
    if kind == "ACTION":
        action = character.source_action
        return SourceMotion(kind, action, _actor(take, character), action.name)
    action = take.finish.action if kind == "FINAL" else take.motion_action
    return SourceMotion(kind, action, take.armature, take.name)


def missing_source(take: bpy.types.PropertyGroup, character: bpy.types.PropertyGroup) -> str | None:
    """What is missing for a character to perform, as a sentence; None where nothing is."""
    kind, actor = _kind(take, character), _actor(take, character)
    if kind == "ACTION" and character.source_action is None:
        return "Choose the Action that the character is to perform"
    if kind == "FINAL" and take.finish.action is None:
        return "Bake the final Action first, or choose another motion"
    if kind == "MOTION" and take.motion_action is None:
        return "Reconstruct the motion first"
    if actor is None:
        return "The motion's actor is gone; choose its armature in the step Actor"
    if not is_actor(actor):
        return f"'{actor.name}' is no actor of Keymark's; choose the motion's actor"
    return None


def _kind(take: bpy.types.PropertyGroup, character: bpy.types.PropertyGroup) -> str:
    """The kind of motion, where the newest is asked for the newest."""
    if character.source != "NEWEST":
        return str(character.source)
    final = take.finish
    newer = final.outdated and take.motion_action is not None
    return "FINAL" if final.action is not None and not newer else "MOTION"


def _actor(take: bpy.types.PropertyGroup, character: bpy.types.PropertyGroup) -> bpy.types.Object | None:
    if character.source == "ACTION" and character.source_actor is not None:
        return character.source_actor
    return take.armature
