"""Give the take's motion to a character."""

from dataclasses import replace
from typing import Any

import bpy
from bpy.types import Context, Operator, PropertyGroup, Scene

from ...core.errors import InputError
from ...core.progress import Job, stretch
from ...core.retarget.quality import Quality
from ...core.take.conversion_settings import RetargetOptions
from ..bridge.actions import assign_action
from ..finish.bake_motion import mark_motion_asset
from ..shell import need
from ..shell.base_operator import BaseOperator, operator, warn
from ..shell.fields import Integer, read_declared
from ..shell.job_operator import JobOperator
from ..shell.take_state import TakeState, digest_of
from ..shell.takes import active_take, take_by_identifier
from . import characters
from .map_properties import map_of


def retarget_take(scene: Scene) -> Job[tuple[Any, ...]]:
    """Put the motion of the active take onto its chosen character; the scene stays as it is."""
    from ..bridge.character.retarget import read_source, retarget

    take = active_take(scene)
    character = characters.active_character(scene)
    motion = characters.source_of(take, character)
    identifier, armature_object = take.identifier, character.armature
    made_from = digest_of(motion.action)
    uids = armature_object.session_uid, motion.action.session_uid, motion.actor.session_uid
    character_map, options = map_of(character.character_map), options_of(character.options)
    del take, character  # Blender may move them while the job runs
    source, frames = yield from stretch(read_source(motion.actor, motion.action), 0.0, 0.1)
    job = retarget(armature_object, source, frames, character_map, options)
    retargeted = yield from stretch(job, 0.1, 1.0)
    return identifier, uids, motion.kind, motion.title, made_from, retargeted


def keep_retargeted(operator: Operator, scene: Scene, result: tuple[Any, ...]) -> str:
    """Let the character perform the motion; returns a sentence on it."""
    identifier, uids, kind, title, made_from, retargeted = result
    take = take_by_identifier(scene, identifier)
    armatures = {each.armature.session_uid: each for each in take.characters if each.armature is not None}
    there = {each.session_uid: each for each in (*bpy.data.actions, *bpy.data.objects)}
    character, source_action, actor = armatures.get(uids[0]), there.get(uids[1]), there.get(uids[2])
    if character is None or source_action is None or actor is None:
        raise InputError(
            "the character or its motion was removed while the job ran; nothing was changed, run it again"
        )
    earlier = None
    if not character.keep_earlier:
        earlier = characters.result_to_replace(character, kind, source_action)
    into = earlier.action if earlier is not None else f"{title} {character.armature.name}"
    action = retargeted.write(scene, into)
    listed = characters.add_result(
        character, characters.SourceMotion(kind, source_action, actor, title), action, made_from
    )
    listed.lines.clear()
    characters.add_lines(listed.lines, figures(retargeted.quality), "INFO")
    characters.add_lines(listed.lines, (*retargeted.warnings, *retargeted.notes), "ERROR")
    for note in (*retargeted.warnings, *retargeted.notes):
        warn(operator, note)
    return f"'{character.armature.name}' performs '{action.name}'"


class KEYMARK_OT_retarget(JobOperator, bpy.types.Operator):
    """Let the character perform the motion, as an Action of its own"""

    bl_label = "Retarget"
    requirements = (
        characters.character,
        characters.source,
        characters.armature,
        characters.editable,
        characters.recognized,
        need.idle,
    )

    def start(self, scene: Scene) -> Job[tuple[Any, ...]]:
        return retarget_take(scene)

    def finish(self, scene: Scene, result: tuple[Any, ...]) -> None:
        performs = keep_retargeted(self, scene, result)
        self.report({"INFO"}, performs)


def options_of(group: PropertyGroup) -> RetargetOptions:
    """The options that properties hold."""
    options = read_declared(RetargetOptions, group, place="placement")
    return options if group.keys == "TOLERANCE" else replace(options, tolerance_mm=0.0)


def figures(quality: Quality) -> list[str]:
    """Lines on feet, floor, hands (or limbs, where the hands reach nothing) and keys."""
    lines = []
    if quality.skate_mm is not None:
        lines.append(f"Feet slide {quality.skate_mm:.2f} mm a frame")
    if quality.penetration_mm is not None:
        lines.append(f"Soles at most {quality.penetration_mm:.1f} mm below floor")
    if quality.hands_mm is not None:
        lines.append(f"Hands {quality.hands_mm:.0f} mm from what they reach")
    elif quality.arms_deg is not None and quality.legs_deg is not None:
        lines.append(f"Arms {quality.arms_deg:.1f}°, legs {quality.legs_deg:.1f}° off")
    if quality.keys is not None and quality.dense_keys is not None:
        lines.append(f"{quality.keys} keys instead of {quality.dense_keys}")
    return lines


class KEYMARK_OT_show_result(BaseOperator, bpy.types.Operator):
    """Animate the character by this result"""

    bl_label = "Show Result"
    requirements = (
        characters.character,
        characters.result,
        characters.armature,
        characters.editable,
        need.idle,
    )

    index: Integer("Index", "Number of the result in the list, from 0", min=0)

    def run(self, context: Context) -> None:
        character = characters.active_character(context.scene)
        if self.index >= len(character.results) or character.results[self.index].action is None:
            raise InputError(f"there is no result number {self.index}; retarget the motion again")
        assign_action(character.armature, character.results[self.index].action)
        character.active_result = self.index


class KEYMARK_OT_remove_result(BaseOperator, bpy.types.Operator):
    """Remove this result from the list; its Action stays in the file, for you to delete"""

    bl_label = "Remove Result"
    requirements = (characters.character, need.idle)

    index: Integer("Index", "Number of the result in the list, from 0", min=0)

    def run(self, context: Context) -> None:
        chosen = characters.active_character(context.scene)
        if self.index >= len(chosen.results):
            count = len(chosen.results)
            raise InputError(f"there is no result number {self.index}; the character has {count}")
        chosen.results.remove(self.index)
        chosen.active_result = max(0, min(chosen.active_result, len(chosen.results) - 1))


@operator("Mark Asset", characters.character, characters.result, need.idle)
def mark_result_asset(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Mark the character's motion as an asset, with the catalog, tags and details of the step Export"""
    made = characters.shown_result(characters.active_character(context.scene))
    if made is None or made.action is None:
        raise InputError("the result's Action has been deleted; retarget the motion again")
    mark_motion_asset(context, take, made.action, made.source_action, made.source_actor)
    if TakeState(take).of_earlier(made):
        operator.report({"WARNING"}, "The character's motion is of an earlier one; retarget for the newest")
    operator.report({"INFO"}, f"'{made.action.name}' is an asset now; save the .blend to keep it")
