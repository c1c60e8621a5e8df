"""A character's bones recognized, and shown in its properties."""

from contextlib import suppress
from pathlib import Path

import bpy

from ...core.errors import InputError, KeymarkError
from ...core.retarget.roles import ROLES
from ..library import user_folder
from ..shell.messages import capitalized
from .characters import may_be_character, other_with
from .map_conversion import clear_map, map_of, show_map
from .results import drop_results_of_others


def recognize_bones(character: bpy.types.PropertyGroup) -> None:
    """Recognize the bones of a character's armature, and show which play which role.

    Raises:
        InputError: It is no character; the properties keep what they held.
    """
    from ...core.retarget.recognition.recognize import recognize
    from ..bridge.character.read_character import read_character

    armature_object = character.armature
    if not may_be_character(armature_object):
        raise _not_a_character(armature_object)
    found = recognize(read_character(armature_object))
    by_role = {_role_of(sentence): capitalized(sentence) for sentence in found.doubts}
    show_map(character.character_map, found.character_map, by_role)
    show_doubts(character, tuple(sentence for sentence in found.doubts if not _role_of(sentence)))
    character.problem = ""


def show_doubts(character: bpy.types.PropertyGroup, doubts: tuple[str, ...] = ()) -> None:
    """Show what is doubtful about a character's map as a whole."""
    character.doubts.clear()
    for sentence in doubts:
        line = character.doubts.add()
        line.text, line.level = capitalized(sentence), "ERROR"


def all_doubts(character: bpy.types.PropertyGroup) -> list[str]:
    """All that is doubtful about a character's map, in sentences."""
    doubted = [role.doubt for role in character.character_map.roles if role.doubt]
    return [line.text for line in character.doubts] + doubted


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
    known = other_with(character, character.armature)
    if known is not None:
        show_map(character.character_map, map_of(known.character_map))
        return
    with suppress(ModuleNotFoundError):  # operators report it
        try:
            recognize_bones(character)
            suggest_map(character)
        except KeymarkError as error:
            character.problem = capitalized(str(error))


def suggest_map(character: bpy.types.PropertyGroup) -> None:
    """Show the title of the map in the user's folder that is for the bones of a character's armature."""
    from ...core.retarget.maps.map_registry import map_for
    from ..bridge.character.read_character import read_character

    found = map_for(read_character(character.armature), map_folders())
    character.suggested = "" if found is None else found.title


def map_folders() -> list[Path]:
    """Folders in which character maps are looked for: that of the user's keyframe libraries."""
    return [user_folder.own_folder()]


def _not_a_character(armature_object: bpy.types.Object | None) -> InputError:
    if armature_object is None:
        return InputError("no armature is chosen; choose the character's")
    name = armature_object.name
    if armature_object.type != "ARMATURE":
        return InputError(f"'{name}' is no armature; choose the character's")
    return InputError(
        f"'{name}' is an actor of Keymark's, which shows the motion already; choose the armature of "
        "another character"
    )
