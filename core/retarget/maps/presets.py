"""Presets: character maps of conventions of bone names, found by the bones that they require."""

import re
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any

from ...files.json_file import json_files, read_json
from ...files.kinds import Never
from ...files.records import declared
from ..character import Character
from .character_map import Bones, CharacterMap

SHIPPED = Path(__file__).resolve().parents[3] / "presets" / "characters"  # the presets that come with Keymark

_SEPARATORS = re.compile(r"[\s._-]+")
_PREFIX = re.compile(r"(?:.*[^a-z0-9])?", re.DOTALL)
"""What may stand before all names of a character: nothing, or a namespace that ends in a sign."""


@dataclass(frozen=True, kw_only=True)
class _PresetFields(CharacterMap):
    """The fields of a preset's file."""

    SCHEMA, TITLE = "keymark-character-preset", "preset of characters"
    ORDER = (*CharacterMap.ORDER, "requires", "lacks")

    preset: Annotated[None, Never("has the field 'preset'; a preset is one itself, leave it out")] = None
    requires: Bones
    lacks: Bones = ()


@dataclass(frozen=True)
class Preset:
    """A convention of bone names."""

    identifier: str  # name of its file, without the ending
    character_map: CharacterMap  # its map, of the bones that a full character has
    requires: tuple[str, ...]  # bones by which it is found: all must be there
    lacks: tuple[str, ...] = ()  # bones that must not be there


def preset_from_json(value: Any, where: str, identifier: str) -> Preset:
    """Read a preset from JSON that is not trusted: a character map's fields, and `requires` and `lacks`.

    Raises:
        InputError: The JSON is no valid preset; the sentence begins with `where`.
    """
    read = _PresetFields.from_json(value, where)
    given = {name: getattr(read, name) for name in declared(CharacterMap)}
    roles = {role: replace(bones, source="preset") for role, bones in read.roles.items()}
    character_map = CharacterMap(**given | {"preset": identifier, "roles": roles})
    return Preset(identifier, character_map, read.requires, read.lacks)


@lru_cache(maxsize=1)
def shipped_presets() -> tuple[Preset, ...]:
    """The presets that come with Keymark, in order of their files."""
    files = json_files(SHIPPED)
    return tuple(preset_from_json(read_json(path, 2**20), str(path), path.stem) for path in files)


def find_preset(character: Character, presets: tuple[Preset, ...] | None = None) -> CharacterMap | None:
    """The map of the convention that a character's bones follow, with the character's own names.

    Of several (by default the shipped ones) the one that requires most bones; what the character lacks is
    left out.
    """
    names: dict[str, str] = {}
    for bone in character.bones:  # of several names with one key the first
        names.setdefault(_key(bone.name), bone.name)
    found: list[tuple[int, int, CharacterMap]] = []
    for preset in shipped_presets() if presets is None else presets:
        first = _key(preset.requires[0])
        prefixes = [key[: -len(first)] for key in names if key.endswith(first)]
        for prefix in sorted(filter(_PREFIX.fullmatch, prefixes), key=len):
            own = {name: names.get(prefix + _key(name)) for name in (*preset.requires, *preset.lacks)}
            if all(own[name] for name in preset.requires) and not any(own[name] for name in preset.lacks):
                known = preset.character_map
                fitted = known.renamed(lambda name, prefix=prefix: names.get(prefix + _key(name)))  # type: ignore[misc]
                found.append((len(preset.requires), len(fitted.named_bones), fitted))
                break
    return max(found, key=lambda each: each[:2])[2] if found else None


@lru_cache(maxsize=4096)
def _key(name: str) -> str:
    """Equal for names that exporters turn into each other: by case and separators."""
    return _SEPARATORS.sub("_", name.casefold())
