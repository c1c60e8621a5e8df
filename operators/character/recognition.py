"""Giving a bone to a role, as operators and their tooltips share it."""

from contextlib import suppress
from pathlib import Path

import bpy

from ...core.errors import InputError, KeymarkError
from ...core.retarget.character import ROLES
from ..library import registry
from ..shell.base_operator import BaseOperator, capitalized, warn
from ..shell.fields import SKIP_SAVE, Integer, Text
from ..shell.requirements import idle
from .characters import (
    active_character,
    add_lines,
    drop_results_of_others,
    find_character,
    full_title,
    require_character_armature,
    with_map,
)
from .map_properties import SOURCE_WORDS, clear_map, map_of, role_named, show_map
from .requirements import armature


class RoleBoneOperator:
    """Mixin of an operator that gives a role a bone."""

    role: Text("Role", "The role, as in upper_arm.L", options=SKIP_SAVE)
    index: Integer("Index", "Number of the bone in a chain, from 0", min=0, options=SKIP_SAVE)


def give_bone(character: bpy.types.PropertyGroup, role: str, index: int, bone: str) -> None:
    """Give a role a bone, which makes the role the person's.

    InputError: there is no such role or place in it, or no such bone.
    """
    if role not in ROLES:
        raise InputError(f"there is no role '{role}'; roles are {', '.join(ROLES)}")
    if bone not in character.armature.data.bones:
        raise InputError(
            f"'{character.armature.name}' has no bone '{bone}'; give the name of one of its bones"
        )
    shown = role_named(character.character_map, role)
    if index >= len(shown.bones):
        raise InputError(
            f"the role {role} has {len(shown.bones)} bones, so there is no number {index}; add a bone first"
        )
    shown.bones[index].bone = bone


def active_bone_of(character: bpy.types.PropertyGroup) -> str | None:
    """Name of the active bone of a character's armature; None where there is none."""
    active = character.armature.data.bones.active if character.armature is not None else None
    return active.name if active is not None else None


def told(context: bpy.types.Context, role: str) -> str:
    """Where a role's bones come from and why they are doubtful, for a tooltip; empty where unknown."""
    character = find_character(context.scene)
    if character is None or role not in character.character_map.roles:
        return ""
    shown = character.character_map.roles[role]
    if shown.doubt:
        return shown.doubt[:1].upper() + shown.doubt[1:]
    if not any(entry.bone for entry in shown.bones):
        return f"{full_title(role).capitalize()}: no bone"
    if shown.source == "you":
        return f"{full_title(role).capitalize()}: chosen by you"
    return (
        f"{full_title(role).capitalize()}: found by {SOURCE_WORDS[shown.source].lower()}, "
        f"{100.0 * shown.confidence:.0f} % sure"
    )


# --- A character's bones recognized, and shown in its properties


def recognize_bones(character: bpy.types.PropertyGroup) -> None:
    """Recognize the bones of a character's armature, and show which play which role.

    InputError: it is no character; the properties keep what they held.
    """
    from ...core.retarget.recognition.recognize import recognize
    from ..bridge.character.read_character import read_character

    require_character_armature(character.armature)
    found = recognize(read_character(character.armature))
    by_role = {_role_of(sentence): capitalized(sentence) for sentence in found.doubts}
    show_map(character.character_map, found.character_map, by_role)
    show_doubts(character, tuple(sentence for sentence in found.doubts if not _role_of(sentence)))
    character.problem = ""


def show_doubts(character: bpy.types.PropertyGroup, doubts: tuple[str, ...] = ()) -> None:
    """Show what is doubtful about a character's map as a whole."""
    character.doubts.clear()
    add_lines(character.doubts, doubts, "ERROR")


def say_recognized(operator: BaseOperator, character: bpy.types.PropertyGroup) -> None:
    """Report what came of recognizing a character's bones: what is wrong, or all that is doubtful."""
    doubts = [line.text for line in character.doubts]
    doubts += [role.doubt for role in character.character_map.roles if role.doubt]
    for sentence in [character.problem] if character.problem else doubts:
        warn(operator, sentence)
    if not character.problem and not doubts:
        operator.report({"INFO"}, f"Recognized the bones of '{character.armature.name}'")


def _role_of(sentence: str) -> str:
    """The role that a doubt is about, with whose name it begins; empty where it is about none alone."""
    word = sentence.partition(" ")[0]
    return word if word in ROLES else ""


def armature_chosen(character: bpy.types.PropertyGroup) -> None:
    """Find out about the armature that was chosen: the map it has elsewhere in the file, or recognition.

    A person may be in the middle of choosing: what is wrong is shown in the panel and not raised.
    """
    clear_map(character.character_map)
    show_doubts(character)
    character.problem = character.suggested = ""
    if character.armature is None:
        return
    drop_results_of_others(character)
    known = with_map(character.armature, beside=character)
    if known is not None:
        show_map(character.character_map, map_of(known.character_map))
        return
    with suppress(ModuleNotFoundError):  # operators report it
        from ...core.retarget.maps.map_registry import map_for
        from ..bridge.character.read_character import read_character

        try:
            recognize_bones(character)
            found = map_for(read_character(character.armature), map_folders())
            character.suggested = "" if found is None else found.title
        except KeymarkError as error:
            character.problem = capitalized(str(error))


def map_folders() -> list[Path]:
    """Folders in which character maps are looked for: that of the user's keyframe libraries."""
    return [registry.own_folder()]


class KEYMARK_OT_recognize_character(BaseOperator, bpy.types.Operator):
    """Find out which bones play which role, by their names and places; replaces what you chose before"""

    bl_label = "Recognize"
    requirements = (armature, idle)

    def run(self, context: bpy.types.Context) -> None:
        character = active_character(context.scene)
        recognize_bones(character)
        say_recognized(self, character)
