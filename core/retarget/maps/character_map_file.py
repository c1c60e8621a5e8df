"""Character map files: one JSON object, readable by people and validated as untrusted input.

`docs/character_map_format.md` describes the fields. Writing a map that was read gives the same bytes.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...errors import InputError
from ...files.digest import digest
from ...files.fields import Fields
from ...files.json_file import read_json, shown
from ...files.json_layout import write_readable_json
from ..roles import LIMBS, ROLES
from .character_map import CharacterMap, IkControls, RoleBones
from .character_map_fields import SOLE_ROLES, read_map_fields

SCHEMA = "keymark-character"
SCHEMA_VERSION = 1
LARGEST_BYTES = 2**20
DECIMALS = 9


def read_character_map(path: Path) -> CharacterMap:
    """Read a character map file.

    Raises:
        InputError: The file is missing, no character map, or invalid.
    """
    return map_from_json(read_json(path, LARGEST_BYTES), str(path))


def write_character_map(path: Path, character_map: CharacterMap) -> None:
    """Write a character map file, whole or not at all.

    Raises:
        InputError: The map is invalid and could not be read back.
        ConversionError: The file cannot be written.
    """
    value = map_to_json(character_map)
    map_from_json(value, f"character map {shown(character_map.title)}")
    write_readable_json(path, value)


def map_from_json(value: Any, where: str) -> CharacterMap:
    """Read a map from JSON that is not trusted; the inverse of `map_to_json`.

    Raises:
        InputError: The JSON is no valid character map; `where` begins the sentence.
    """
    fields = Fields.of(value, where)
    check_schema(fields)
    return read_map_fields(fields)


def check_schema(fields: Fields) -> None:
    """Check that the fields are those of a character map, of a version that is read.

    Raises:
        InputError: They are not.
    """
    schema = fields.values.get("schema")
    if schema != SCHEMA:
        raise InputError(f'{fields.where}: schema is {shown(schema)}; a character map has "{SCHEMA}" there')
    fields.check_version(SCHEMA_VERSION)


def map_to_json(character_map: CharacterMap) -> dict[str, Any]:
    """A map as a JSON object, its fields in the order of the file, without empty ones."""
    value: dict[str, Any] = {
        "schema": SCHEMA,
        "schema_version": SCHEMA_VERSION,
        "title": character_map.title,
        "preset": character_map.preset,
        "author": character_map.author,
        "license": character_map.license,
        "description": character_map.description,
        "tags": list(character_map.tags),
        "roles": roles_to_json(character_map.roles),
        "fk": {role: list(character_map.fk[role]) for role in ROLES if role in character_map.fk},
        "ik": {limb: _controls_to_json(character_map.ik[limb]) for limb in LIMBS if limb in character_map.ik},
        "settings": [
            {"bone": one.bone, "property": one.property, "value": _property_value(one.value)}
            for one in character_map.settings
        ],
        "root": character_map.root,
        "soles": {
            role: [[_number(part) for part in point] for point in character_map.soles[role]]
            for role in SOLE_ROLES
            if role in character_map.soles
        },
        "rest_corrections": {
            role: [_number(part) for part in character_map.rest_corrections[role]]
            for role in ROLES
            if role in character_map.rest_corrections
        },
        "left_alone": list(character_map.left_alone),
    }
    return {name: item for name, item in value.items() if item or name == "roles"}


def map_digest(character_map: CharacterMap) -> str:
    """Digest of a map's content, whatever the path and the layout of its file."""
    return digest(json.dumps(map_to_json(character_map), sort_keys=True))


def roles_to_json(roles: Mapping[str, RoleBones]) -> dict[str, Any]:
    """The field `roles`."""
    return {role: _role_to_json(roles[role]) for role in ROLES if role in roles}


def _role_to_json(role: RoleBones) -> dict[str, Any]:
    value: dict[str, Any] = {"bones": list(role.bones)}
    value |= {"confidence": _number(role.confidence), "source": role.source}
    return value | ({"shares": [_number(share) for share in role.shares]} if role.shares else {})


def _controls_to_json(controls: IkControls) -> dict[str, Any]:
    value: dict[str, Any] = {"goal": controls.goal}
    value |= {name: bone for name, bone in (("pole", controls.pole), ("toe", controls.toe)) if bone}
    if controls.switch is not None:
        switch = controls.switch
        value["switch"] = {
            "bone": switch.bone,
            "property": switch.property,
            "ik": _number(switch.ik),
            "fk": _number(switch.fk),
        }
    return value


def _property_value(value: float | int | bool) -> float | int | bool:
    """Whole numbers and truth values stay what they are: a property of Blender has a type."""
    return _number(value) if isinstance(value, float) else value


def _number(value: float) -> float:
    return round(float(value), DECIMALS) + 0.0  # no negative zero
