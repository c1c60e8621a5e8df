"""Whether a character map is for a character: all bones that it names must be there."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from ...errors import InputError, shown
from ...files.fields import listed
from ...files.json_file import ENDING, is_other_format, is_path, json_files, read_json
from ...prior.library import LARGEST_BYTES
from ...prior.texts import identifier_from, name_key
from ...take.character_settings import AUTO, NO_MAP
from ..character import REQUIRED, Character
from ..recognition.recognize import recognize
from ..retarget_record import GIVEN, RECOGNIZED, SAVED
from .character_map import CharacterMap, map_digest, read_character_map

MOST_NAMED = 5  # missing bones that are named in a sentence


def missing_bones(character_map: CharacterMap, character: Character) -> tuple[str, ...]:
    """Bones that the map names and the character lacks, those of roles first."""
    return tuple(name for name in character_map.named_bones if name not in character.index)


def check_map(character_map: CharacterMap, character: Character, where: str = "") -> None:
    """Refuse a map for another character, or one without the roles that every character has.

    Raises:
        InputError: A bone or a role is missing; the sentence begins with `where`, by default the map's
            title.
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


# --- Registry of character maps


@dataclass(frozen=True)
class RegisteredMap:
    """A character map file in a registered folder."""

    path: Path
    character_map: CharacterMap | None  # the map; None if the file is invalid
    problem: str = ""  # the sentence of the error that makes it invalid

    @property
    def title(self) -> str:
        """The map's title; an invalid file's name."""
        return self.character_map.title if self.character_map else self.path.name


def registered_maps(folders: Sequence[Path]) -> tuple[RegisteredMap, ...]:
    """All character maps in some folders, in order of title; missing folders count as empty.

    Keyframe libraries may lie in the same folders. Of several maps with one title only the one in the
    earliest folder is registered, and within a folder the first by file name; the others are available by
    path only.
    """
    found: dict[str, RegisteredMap] = {}
    broken: list[RegisteredMap] = []
    for folder in folders:
        for path in json_files(folder):
            entry = _read(path)
            if entry is None:
                continue
            if entry.character_map is None:
                broken.append(entry)
            else:
                found.setdefault(name_key(entry.title), entry)
    return tuple(sorted([*found.values(), *broken], key=lambda entry: (entry.title.casefold(), entry.path)))


def find_map(name_or_path: str | Path, folders: Sequence[Path]) -> RegisteredMap:
    """Find a map by its title, its file's name without `.json`, or its path.

    Raises:
        InputError: There is no such map, or it is invalid.
    """
    if is_path(name_or_path):
        path = Path(name_or_path)
        return RegisteredMap(path, read_character_map(path))
    text = os.fspath(name_or_path)
    registered = registered_maps(folders)
    wanted = name_key(text)
    named = [entry for entry in registered if wanted in (name_key(entry.title), name_key(entry.path.stem))]
    for entry in sorted(named, key=lambda entry: entry.character_map is None):
        if entry.character_map is None:
            raise InputError(entry.problem)
        return entry
    titles = [entry.title for entry in registered if entry.character_map]
    close = get_close_matches(text[:100], titles, n=1, cutoff=0.6)
    hint = f" (is {shown(close[0])} meant?)" if close else ""
    raise InputError(
        f"there is no character map {shown(text)}{hint}; known are {listed(titles) or 'none'}, "
        "and the path of a file ends in .json"
    )


def map_for(character: Character, folders: Sequence[Path]) -> RegisteredMap | None:
    """The registered map all of whose bones a character has; of several the one that names the most bones."""
    fitting = [
        (len(entry.character_map.named_bones), entry)
        for entry in registered_maps(folders)
        if entry.character_map is not None and not missing_bones(entry.character_map, character)
    ]
    return max(fitting, key=lambda each: each[0])[1] if fitting else None


def map_path(folder: Path, title: str) -> Path:
    """Path of the file of a map with this title in a folder: the one that has it, else a new one.

    Never outside of the folder, and never one that holds something else.
    """
    for path in json_files(folder):
        entry = _read(path)
        if entry is not None and entry.character_map and name_key(entry.title) == name_key(title):
            return path
    return folder / (identifier_from(title, [path.stem for path in json_files(folder)], "character") + ENDING)


def _read(path: Path) -> RegisteredMap | None:
    """The map of a file; None for a file of another of Keymark's formats."""
    try:
        value = read_json(path, LARGEST_BYTES)  # a library, which is larger, is no damaged map
        if is_other_format(value, CharacterMap.SCHEMA):
            return None
        return RegisteredMap(path, CharacterMap.from_json(value, str(path)))
    except InputError as error:
        return RegisteredMap(path, None, str(error))


# --- Choice of a character's map


@dataclass(frozen=True)
class ChosenMap:
    """A character's map, and where it comes from."""

    character_map: CharacterMap
    origin: str  # one of `retarget_record.ORIGINS`
    path: Path | None = None  # its file; None where it was recognized
    doubts: tuple[str, ...] = ()  # what was recognized without being sure, one sentence each


def choose_map(character: Character, wanted: str, folders: Sequence[Path]) -> ChosenMap:
    """The map of a character: the one with the wanted title or path, or the one found.

    `auto` takes a saved one that knows the character's bones, else recognition; `none` recognition alone.

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
