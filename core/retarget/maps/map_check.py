"""Whether a character map is for a character: all bones that it names must be there."""

from ...errors import InputError
from ...files.fields import listed
from ...files.json_file import shown
from ..character import Character
from ..roles import REQUIRED
from .character_map import CharacterMap

MOST_NAMED = 5
"""Missing bones that are named in a sentence."""


def missing_bones(character_map: CharacterMap, character: Character) -> tuple[str, ...]:
    """Bones that the map names and the character lacks, those of roles first."""
    return tuple(name for name in character_map.named_bones if name not in character.index)


def check_map(character_map: CharacterMap, character: Character, where: str = "") -> None:
    """Refuse a map for another character, or one without the roles that every character has.

    Args:
        character_map: The map.
        character: The character that it is to be used for.
        where: The map's file for the sentence; by default it is named by its title.

    Raises:
        InputError: A bone or a role is missing.
    """
    name = where or f"character map {shown(character_map.title)}"
    missing = missing_bones(character_map, character)
    if missing:
        raise InputError(
            f"{name} is for another character: '{character.name}' has no bone "
            f"{listed(map(shown, missing), MOST_NAMED)}; choose a map made for its bones, or recognize them"
        )
    absent = [role for role in REQUIRED if role not in character_map.roles]
    if absent:
        raise InputError(
            f"{name} gives no bones for {listed(absent, MOST_NAMED)} of '{character.name}'; "
            f"a character map needs {listed(REQUIRED)}"
        )
