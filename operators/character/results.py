"""Results of retargeting, in a character's list."""

from collections.abc import Iterable

import bpy

from ..shell.messages import capitalized
from .characters import shown_result
from .source_motion import SourceMotion

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
    character: bpy.types.PropertyGroup, source: SourceMotion, action: bpy.types.Action
) -> bpy.types.PropertyGroup:
    """List an Action as a result, in place of what was listed of it, and choose it; deleted ones go."""
    for empty in reversed([i for i, each in enumerate(character.results) if each.action is None]):
        character.results.remove(empty)
    index = next((i for i, each in enumerate(character.results) if each.action == action), None)
    if index is None:
        index = len(character.results)
        character.results.add()
    result = character.results[index]
    result.action, result.outdated, result.armature = action, False, character.armature
    result.source, result.source_action, result.source_actor = source.kind, source.action, source.actor
    character.active_result = index
    return result


def drop_results_of_others(character: bpy.types.PropertyGroup) -> None:
    """Take results that move another armature than the chosen one out of the list; their Actions stay."""
    others = [i for i, each in enumerate(character.results) if each.armature != character.armature]
    for index in reversed(others):
        character.results.remove(index)
    character.active_result = max(0, len(character.results) - 1)


def show_lines(result: bpy.types.PropertyGroup, figures: Iterable[str], notes: Iterable[str]) -> None:
    """Show what was measured of a result, and what a person should look at."""
    result.lines.clear()
    for level, sentences in (("INFO", figures), ("ERROR", notes)):
        for sentence in sentences:
            line = result.lines.add()
            line.text, line.level = capitalized(sentence), level


def is_shown(character: bpy.types.PropertyGroup, result: bpy.types.PropertyGroup) -> bool:
    """Whether a result animates its character now."""
    data = character.armature.animation_data if character.armature is not None else None
    return data is not None and data.action is not None and data.action == result.action
