"""Validation of a character map's fields: each mistake is an `InputError` of one sentence.

Conventions in `presets/characters` have the same fields and a few more; both are read here.
"""

from collections.abc import Collection, Iterable, Mapping
from math import hypot

from ...errors import InputError
from ...files.control_characters import is_control_character
from ...files.fields import Fields, listed
from ...files.json_file import shown
from ...library.text_fields import (
    LONGEST_LINE,
    LONGEST_TAG,
    LONGEST_TEXT,
    MOST_TAGS,
    item_list,
    license_expression,
    object_list,
    optional_line,
    text_line,
    text_lines,
)
from ...library.texts import LONGEST_NAME
from ..roles import CHAINS, LIMBS, ROLES, SOURCES
from .character_map import CharacterMap, IkControls, Point, RoleBones, Setting, Switch

MOST_BONES, MOST_SETTINGS, MOST_SOLE_POINTS = 100, 1000, 1000
"""Most bones of one role; settings; points of one sole."""
LONGEST_BONE = 255
"""Characters of a bone's or a property's name; Blender's own have up to 63 bytes."""
FARTHEST = 1e6
"""Largest coordinate of a sole, in the armature's units, and largest value of a property."""
ROUGH_LENGTH, EXACT_LENGTH = 1e-3, 1e-8
"""How far a rest correction's length may be from 1; one that is farther than the second is made 1."""
SOLE_ROLES = tuple(role for role in ROLES if role.partition(".")[0] in ("foot", "toe"))
HEADER = (
    *("schema", "schema_version", "title", "preset", "author", "license", "description", "tags"),
    *("roles", "fk", "ik", "settings", "root", "soles", "rest_corrections", "left_alone"),
)

Quaternion = tuple[float, float, float, float]


def read_map_fields(fields: Fields, source: str = "you", others: Collection[str] = ()) -> CharacterMap:
    """Read a character map from the fields of its file.

    Args:
        fields: The fields.
        source: Where a role comes from that does not say so itself.
        others: Further fields that the file may have, for the caller to read.

    Raises:
        InputError: A field is missing, unknown or invalid.
    """
    fields.refuse_others((*HEADER, *others))
    roles = read_roles(fields, source)
    return CharacterMap(
        title=text_line(fields, "title", LONGEST_NAME),
        roles=roles,
        fk=_fk(fields, roles),
        ik=_ik(fields),
        settings=_settings(fields),
        root=_optional_name(fields, "root", BONE),
        soles=_soles(fields),
        rest_corrections=_rest_corrections(fields),
        left_alone=_left_alone(fields),
        preset=text_line(fields, "preset", LONGEST_NAME) if fields.has("preset") else None,
        author=optional_line(fields, "author", LONGEST_LINE),
        license=license_expression(fields) if fields.has("license") else "",
        description=optional_line(fields, "description", LONGEST_TEXT),
        tags=text_lines(fields, "tags", MOST_TAGS, LONGEST_TAG),
    )


BONE = f"a bone's name, of at most {LONGEST_BONE} characters"
PROPERTY = f"a custom property's name, of at most {LONGEST_BONE} characters"


def checked_name(value: object, where: str, valid: str = BONE) -> str:
    """The name of a bone or property, which may be any visible text: not all are made by Blender.

    Raises:
        InputError: It is no text, empty, too long or has control characters; `where` begins the sentence.
    """
    if (
        not isinstance(value, str)
        or not value.strip()
        or len(value) > LONGEST_BONE
        or any(map(is_control_character, value))
    ):
        raise InputError(f"{where} is {shown(value)}; it must be {valid}")
    return value


def bone_names(fields: Fields, name: str, most: int = MOST_BONES) -> tuple[str, ...]:
    """A list of one or more bones, each once."""
    names = [
        checked_name(value, f"{fields.where}: {name}[{index}]")
        for index, value in enumerate(item_list(fields, name, "bones", 1, most))
    ]
    _refuse_twice(names, f"{fields.where}: {name}", "bone")
    return tuple(names)


def _name(fields: Fields, name: str, valid: str) -> str:
    return checked_name(fields.required(name, valid), f"{fields.where}: {name}", valid)


def _optional_name(fields: Fields, name: str, valid: str) -> str | None:
    return _name(fields, name, valid) if fields.has(name) else None


def _object(fields: Fields, name: str, known: Collection[str], of_what: str) -> Fields:
    """An object by role or limb; empty where it is missing."""
    if not fields.has(name):
        return Fields({}, f"{fields.where}: {name}")
    child = fields.child(name, f"an object of {of_what}")
    child.refuse_others(known)
    return child


def read_roles(fields: Fields, source: str = "you") -> Mapping[str, RoleBones]:
    """The field `roles`: the bones of each role, in the order of `ROLES`."""
    child = fields.child("roles", "an object of bones by role")
    child.refuse_others(ROLES)
    if not child.values:
        raise InputError(f"{child.where} is empty; a character map has roles, hips first")
    found = {role: _role(child, role, source) for role in ROLES if role in child.values}
    seen: dict[str, str] = {}
    for role, bones in found.items():
        for bone in bones.bones:
            other = seen.setdefault(bone, role)
            if other != role:
                raise InputError(
                    f"{child.where}: {shown(bone)} plays {other} and {role}; each role needs bones of its own"
                )
    return found


def _role(roles: Fields, role: str, source: str) -> RoleBones:
    fields = roles.child(role, "an object with bones")
    fields.refuse_others(("bones", "confidence", "source", "shares"))
    bones = bone_names(fields, "bones", MOST_BONES if role in CHAINS else 1)
    given = fields.text("source", listed(SOURCES)) if fields.has("source") else source
    if given not in SOURCES:
        raise InputError(f"{fields.where}: source is {shown(given)}; it must be one of {listed(SOURCES)}")
    confidence = fields.number("confidence", 0.0, 1.0) if fields.has("confidence") else 1.0
    return RoleBones(bones, confidence, given, _shares(fields, role, len(bones)))


def _shares(fields: Fields, role: str, count: int) -> tuple[float, ...]:
    if not fields.has("shares"):
        return ()
    if role not in CHAINS:
        raise InputError(f"{fields.where}: shares is for {listed(CHAINS)} alone; leave it out")
    valid = f"{count} numbers from 0 to 1, one a bone, none below the one before"
    shares = fields.numbers("shares", count, 0.0, 1.0, valid)
    if list(shares) != sorted(shares):
        raise InputError(f"{fields.where}: shares is {shown(list(shares))}; it must be {valid}")
    return shares


def _fk(fields: Fields, roles: Mapping[str, RoleBones]) -> Mapping[str, tuple[str | None, ...]]:
    child = _object(fields, "fk", ROLES, "keyed bones by role")
    found: dict[str, tuple[str | None, ...]] = {}
    for role in (role for role in ROLES if role in child.values):
        if role not in roles:
            raise InputError(f"{child.where}: {role} is keyed, but roles says no bone for it")
        count = len(roles[role].bones)
        items = item_list(child, role, f"bones or null, as many as the bones of {role}", count, count)
        found[role] = tuple(
            None if item is None else checked_name(item, f"{child.where}: {role}[{index}]")
            for index, item in enumerate(items)
        )
    keyed = [bone for bones in found.values() for bone in bones if bone is not None]
    _refuse_twice(keyed, child.where, "bone")
    return found


def _ik(fields: Fields) -> Mapping[str, IkControls]:
    child = _object(fields, "ik", tuple(LIMBS), "controls by limb")
    return {limb: _controls(child, limb) for limb in LIMBS if limb in child.values}


def _controls(limbs: Fields, limb: str) -> IkControls:
    fields = limbs.child(limb, "an object with goal")
    fields.refuse_others(("goal", "pole", "toe", "switch"))
    if fields.has("toe") and not limb.startswith("leg"):
        raise InputError(f"{fields.where}: toe is a control of legs alone; leave it out")
    return IkControls(
        goal=_name(fields, "goal", BONE),
        pole=_optional_name(fields, "pole", BONE),
        toe=_optional_name(fields, "toe", BONE),
        switch=_switch(fields) if fields.has("switch") else None,
    )


def _switch(controls: Fields) -> Switch:
    fields = controls.child("switch", "an object with bone, property, ik and fk")
    fields.refuse_others(("bone", "property", "ik", "fk"))
    ik, fk = (fields.number(name, -FARTHEST, FARTHEST) for name in ("ik", "fk"))
    if ik == fk:
        raise InputError(f"{fields.where}: ik and fk are both {ik:g}; a switch has two values")
    return Switch(_name(fields, "bone", BONE), _name(fields, "property", PROPERTY), ik, fk)


def _settings(fields: Fields) -> tuple[Setting, ...]:
    if not fields.has("settings"):
        return ()
    found: list[Setting] = []
    for row in object_list(fields, "settings", "settings", 0, MOST_SETTINGS):
        row.refuse_others(("bone", "property", "value"))
        value = row.required("value", "a number, true or false")
        if not isinstance(value, bool):
            row.number("value", -FARTHEST, FARTHEST)
        found.append(Setting(_name(row, "bone", BONE), _name(row, "property", PROPERTY), value))
    _refuse_twice([f"{one.bone} {one.property}" for one in found], f"{fields.where}: settings", "property")
    return tuple(found)


def _soles(fields: Fields) -> Mapping[str, tuple[Point, ...]]:
    child = _object(fields, "soles", SOLE_ROLES, "lists of points by role")
    return {
        role: tuple(_point(child, role, index, point) for index, point in enumerate(_points(child, role)))
        for role in SOLE_ROLES
        if role in child.values
    }


def _points(soles: Fields, role: str) -> list[object]:
    return item_list(soles, role, "points [x, y, z]", 1, MOST_SOLE_POINTS)


def _point(soles: Fields, role: str, index: int, value: object) -> Point:
    valid = f"a point [x, y, z] within {FARTHEST:g} of the armature's origin"
    x, y, z = Fields({f"{role}[{index}]": value}, soles.where).numbers(
        f"{role}[{index}]", 3, -FARTHEST, FARTHEST, valid
    )
    return (x, y, z)


def _rest_corrections(fields: Fields) -> Mapping[str, Quaternion]:
    child = _object(fields, "rest_corrections", ROLES, "quaternions by role")
    return {role: _quaternion(child, role) for role in ROLES if role in child.values}


def _quaternion(fields: Fields, role: str) -> Quaternion:
    valid = "a turn as a quaternion [w, x, y, z] of length 1"
    w, x, y, z = fields.numbers(role, 4, -1.0 - ROUGH_LENGTH, 1.0 + ROUGH_LENGTH, valid)
    length = hypot(w, x, y, z)
    if abs(length - 1.0) > ROUGH_LENGTH:
        raise InputError(f"{fields.where}: {role} is {shown([w, x, y, z])}; it must be {valid}")
    if abs(length - 1.0) <= EXACT_LENGTH:
        return (w, x, y, z)
    return (w / length, x / length, y / length, z / length)


def _left_alone(fields: Fields) -> tuple[str, ...]:
    if not fields.has("left_alone"):
        return ()
    items = item_list(fields, "left_alone", "roles", 0, len(ROLES))
    for index, item in enumerate(items):
        if item not in ROLES:
            raise InputError(
                f"{fields.where}: left_alone[{index}] is {shown(item)}; it must be one of {listed(ROLES)}"
            )
    roles = [str(item) for item in items]
    _refuse_twice(roles, f"{fields.where}: left_alone", "role")
    return tuple(roles)


def _refuse_twice(names: Iterable[str], where: str, what: str) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise InputError(f"{where} names the {what} {shown(name)} twice; each must stand once")
        seen.add(name)
