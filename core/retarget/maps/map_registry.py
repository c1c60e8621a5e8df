"""Character maps held against a character: checked, found, chosen, and one side mirrored to the other."""

import json
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...body.mirror import other_side
from ...errors import InputError, shown
from ...files.digest import digest
from ...files.fields import listed
from ...files.json_file import ENDING, is_path, json_files
from ...files.records import Registered, find_registered, registered_files
from ...prior.library import LARGEST_BYTES
from ...prior.texts import identifier_from, name_key
from ...take.conversion_settings import AUTO, NO_MAP
from ..character import REQUIRED, ROLES, Character
from ..recognition.bones import anatomy
from ..recognition.names import read_name
from ..recognition.recognize import recognize
from ..recognition.symmetry import find_planes, mirrored
from ..retarget_record import GIVEN, RECOGNIZED, SAVED
from .character_map import CharacterMap, RoleBones, read_character_map


def missing_bones(character_map: CharacterMap, character: Character) -> tuple[str, ...]:
    """Bones that the map names and the character lacks, those of roles first."""
    return tuple(name for name in character_map.named_bones if name not in character.index)


def check_map(character_map: CharacterMap, character: Character, where: str = "") -> None:
    """Refuse a map for another character, or one without the roles that every character has.

    Raises:
        InputError: A bone or a role is missing; the sentence begins with `where`, or else the map's title.
    """
    name = where or f"character map {shown(character_map.title)}"
    missing = missing_bones(character_map, character)
    if missing:
        raise InputError(
            f"{name} is for another character: '{character.name}' has no bone "
            f"{listed(map(shown, missing), 5)}; choose a map made for its bones, or recognize them"
        )
    absent = [role for role in REQUIRED if role not in character_map.roles]
    if absent:
        raise InputError(
            f"{name} gives no bones for {listed(absent, 5)} of '{character.name}'; "
            f"a character map needs {listed(REQUIRED)}"
        )


def registered_maps(folders: Sequence[Path]) -> tuple[Registered[CharacterMap], ...]:
    """All character maps in some folders, in order of title; a library, though larger, is no damaged map."""
    return registered_files(folders, CharacterMap, LARGEST_BYTES, lambda one: name_key(one.title))


def find_map(name_or_path: str | Path, folders: Sequence[Path]) -> Registered[CharacterMap]:
    """Find a map by its title, its file's name without `.json`, or its path.

    Raises:
        InputError: There is no such map, or it is invalid.
    """
    if is_path(name_or_path):
        path = Path(name_or_path)
        return Registered(path, read_character_map(path))
    entries = registered_maps(folders)
    found = find_registered(
        os.fspath(name_or_path),
        entries,
        lambda entry: (entry.title, entry.path.stem),
        name_key,
        "character map",
    )
    return replace(found, content=found.valid)


def map_for(character: Character, folders: Sequence[Path]) -> Registered[CharacterMap] | None:
    """The registered map all of whose bones a character has; of several the one that names the most bones."""
    fitting = [
        (len(entry.content.named_bones), entry)
        for entry in registered_maps(folders)
        if entry.content is not None and not missing_bones(entry.content, character)
    ]
    return max(fitting, key=lambda each: each[0])[1] if fitting else None


def map_path(folder: Path, title: str) -> Path:
    """Path of the file of a map with this title in a folder: the one that has it, else a new one.

    Never outside of the folder, and never one that holds something else.
    """
    for entry in registered_maps([folder]):
        if entry.content is not None and name_key(entry.title) == name_key(title):
            return entry.path
    return folder / (identifier_from(title, [path.stem for path in json_files(folder)], "character") + ENDING)


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
    if wanted in (AUTO, NO_MAP):
        saved = map_for(character, folders) if wanted == AUTO else None
    else:
        saved = find_map(wanted, folders)
    if saved is None:
        found = recognize(character)
        return ChosenMap(found.character_map, RECOGNIZED, doubts=tuple(found.doubts))
    check_map(saved.valid, character, str(saved.path))
    return ChosenMap(saved.valid, SAVED if wanted == AUTO else GIVEN, saved.path)


def map_digests(wanted: str, folders: Sequence[Path]) -> tuple[str, ...]:
    """Digests of the maps that `choose_map` may take.

    Raises:
        InputError: There is no such map.
    """
    if wanted == NO_MAP:
        return ()
    if wanted != AUTO:
        entries: Sequence[Registered[CharacterMap]] = [find_map(wanted, folders)]
    else:
        entries = registered_maps(folders)
    known = [entry.content.to_json() for entry in entries if entry.content]
    return tuple(sorted(digest(json.dumps(content, sort_keys=True)) for content in known))


def mirrored_map(
    character: Character, character_map: CharacterMap, from_side: str
) -> tuple[CharacterMap, tuple[str, ...]]:
    """Copy one side of a map to the other, with its controls.

    With the map come the roles of the other side for which no bone was found, which stay as they were.
    """
    given = {role: own for role, own in character_map.roles.items() if role.endswith(f".{from_side}")}
    partner = _partners(character, {name for own in given.values() for name in own.bones})
    ik = {limb: own for limb, own in character_map.ik.items() if limb.endswith(from_side)}
    found = replace(character_map, roles=given, ik=ik, settings=(), root=None).renamed(partner)
    roles, fk = dict(character_map.roles), dict(character_map.fk)
    missing = []
    for role in (role for role in ROLES if role in given):
        own = found.roles.get(role)
        if own is None or len(own.bones) < len(given[role].bones):
            missing.append(other_side(role))
            continue
        roles[other_side(role)] = RoleBones(own.bones, shares=own.shares)
        fk.pop(other_side(role), None)
        if role in found.fk:
            fk[other_side(role)] = found.fk[role]
    mirrored = {other_side(limb): controls for limb, controls in found.ik.items()}
    return replace(character_map, roles=roles, fk=fk, ik=dict(character_map.ik) | mirrored), tuple(missing)


def _partners(character: Character, used: set[str]) -> Callable[[str], str | None]:
    """What finds the partner of a bone; none of those used, which are of the side that is mirrored.

    One whose name differs in the word for the side alone comes before one that only lies there.
    """
    bones = anatomy(character, np.arange(len(character.bones)))
    plane = next(find_planes(bones), None)

    def partner(name: str) -> str | None:
        if name not in character.index:
            return None
        read, own = read_name(name), character.bone(name)
        ranks: dict[str, tuple[bool, float]] = {}
        for other in character.bones:
            off = ends = 0.0
            if plane is not None:
                off = float(np.linalg.norm(other.head - mirrored(own.head, *plane[:2])))
                ends = float(np.linalg.norm(other.tail - mirrored(own.tail, *plane[:2])))
            its = read_name(other.name)
            sides = {read.side, its.side} == {"L", "R"}
            far = not sides or its.unsided.casefold() != read.unsided.casefold()
            # Share of the character's extent by which a mirrored bone may lie off.
            lost = far and (plane is None or off > 0.03 * bones.size)
            if other.name != name and other.name not in used and not lost:
                ranks[other.name] = (far, off + ends)  # bones at one joint, as twist bones, differ in tails
        return min(ranks, key=lambda other: ranks[other], default=None)

    return partner
