"""Choice of a character's map: one that is named, one that was saved for its bones, or recognition."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ...errors import InputError
from ...take.character_settings import AUTO, NO_MAP
from ..character import Character
from ..recognition.recognize import recognize
from ..retarget_record import GIVEN, RECOGNIZED, SAVED
from .character_map import CharacterMap
from .character_map_file import map_digest
from .map_check import check_map
from .map_registry import RegisteredMap, find_map, map_for, registered_maps


@dataclass(frozen=True)
class ChosenMap:
    """A character's map, and where it comes from."""

    character_map: CharacterMap
    origin: str
    """One of `retarget_record.ORIGINS`."""
    path: Path | None = None
    """Its file; None where it was recognized."""
    doubts: tuple[str, ...] = ()
    """What was recognized without being sure, one sentence each."""


def choose_map(character: Character, wanted: str, folders: Sequence[Path]) -> ChosenMap:
    """The map of a character.

    Args:
        character: The character.
        wanted: A map's title or path; `auto` for a saved one that knows the character's bones, else
            recognition; `none` for recognition alone.
        folders: Where saved maps are found.

    Raises:
        InputError: There is no such map, it is for another character, or the bones are no character's.
    """
    if wanted not in (AUTO, NO_MAP):
        named = find_map(wanted, folders)
        return _checked(named, character, GIVEN)
    saved = map_for(character, folders) if wanted == AUTO else None
    if saved is not None:
        return _checked(saved, character, SAVED)
    found = recognize(character)
    return ChosenMap(found.character_map, RECOGNIZED, doubts=tuple(found.doubts))


def map_digests(wanted: str, folders: Sequence[Path]) -> tuple[str, ...]:
    """Digests of the maps that `choose_map` may take, for the digest of what it is used for.

    Raises:
        InputError: There is no such map.
    """
    if wanted == NO_MAP:
        return ()
    if wanted != AUTO:
        entries: Sequence[RegisteredMap] = [find_map(wanted, folders)]
    else:
        entries = registered_maps(folders)
    return tuple(sorted(map_digest(entry.character_map) for entry in entries if entry.character_map))


def _checked(entry: RegisteredMap, character: Character, origin: str) -> ChosenMap:
    if entry.character_map is None:
        raise InputError(entry.problem)
    check_map(entry.character_map, character, str(entry.path))
    return ChosenMap(entry.character_map, origin, entry.path)
