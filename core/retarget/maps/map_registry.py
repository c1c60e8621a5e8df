"""Registry of character maps: those in some folders, found by title, by path, or by a character's bones."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from ...errors import InputError
from ...files.fields import listed
from ...files.json_file import read_json, shown
from ...files.json_folder import ENDING, is_other_format, is_path, json_files
from ...library.library_file import LARGEST_BYTES
from ...library.texts import identifier_from, name_key
from ..character import Character
from .character_map import CharacterMap
from .character_map_file import read_character_map
from .map_check import missing_bones


@dataclass(frozen=True)
class RegisteredMap:
    """A character map file in a registered folder."""

    path: Path
    character_map: CharacterMap | None
    """The map; None if the file is invalid."""
    problem: str = ""
    """The sentence of the error that makes it invalid."""

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
    """The registered map all of whose bones a character has; of several the one that names the most bones.

    Returns:
        The map; None where there is none.
    """
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
