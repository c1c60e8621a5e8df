"""Character maps from properties, and into them."""

from collections.abc import Mapping

import bpy

from ...core.retarget.character import CHAINS, LIMBS, ROLES
from ...core.retarget.maps.character_map import CharacterMap, IkControls, RoleBones, Setting, Switch

DIGITS = 7  # significant digits of values that Blender keeps as float32
WORDS = ("author", "license", "description")
KINDS = {"BOOL": bool, "INT": int, "FLOAT": float}
"""The types of properties' values."""
NO_DOUBTS: Mapping[str, str] = {}


def map_of(group: bpy.types.PropertyGroup) -> CharacterMap:
    """The character map that properties hold; without roles where nothing was recognized yet."""
    roles: dict[str, RoleBones] = {}
    fk: dict[str, tuple[str | None, ...]] = {}
    for role in group.roles:
        chosen = [entry for entry in role.bones if entry.bone]
        if not chosen:
            continue
        shares = tuple(_rounded(entry.share) for entry in chosen) if role.uneven else ()
        bones = tuple(entry.bone for entry in chosen)
        roles[role.name] = RoleBones(bones, _rounded(role.confidence), role.source, shares)
        if any(entry.control or not entry.keyed for entry in chosen):
            fk[role.name] = tuple((entry.control or entry.bone) if entry.keyed else None for entry in chosen)
    return CharacterMap(
        title=group.title,
        roles=roles,
        fk=fk,
        ik={limb.name: _ik_of(limb) for limb in group.limbs if limb.goal},
        settings=tuple(
            Setting(each.bone, each.property, KINDS[each.kind](_rounded(each.value)))
            for each in group.settings
            if each.bone
        ),
        root=group.root or None,
        soles={
            role.name: tuple(tuple(map(_rounded, point.place)) for point in role.sole)
            for role in group.roles
            if len(role.sole)
        },
        rest_corrections={
            role.name: tuple(map(_rounded, role.correction)) for role in group.roles if role.corrected
        },
        left_alone=tuple(role.name for role in group.roles if role.left_alone),
        preset=group.preset or None,
        author=group.author,
        license=group.license,
        description=group.description,
        tags=tuple(tag.strip() for tag in group.tags.split(",") if tag.strip()),
    )


def show_map(
    group: bpy.types.PropertyGroup, character_map: CharacterMap, doubts: Mapping[str, str] = NO_DOUBTS
) -> None:
    """Set properties to a character map, with doubts by role; roles without bones have an empty entry."""
    clear_map(group)
    group.title, group.root = character_map.title, character_map.root or ""
    group.preset = character_map.preset or ""
    for name in WORDS:
        setattr(group, name, getattr(character_map, name))
    group.tags = ", ".join(character_map.tags)
    for name in ROLES:
        _show_role(group.roles.add(), name, character_map, doubts.get(name, ""))
    for name in LIMBS:
        limb, controls = group.limbs.add(), character_map.ik.get(name)
        limb.name = name
        if controls is not None:
            limb.goal, limb.pole, limb.toe = controls.goal, controls.pole or "", controls.toe or ""
            if (switch := controls.switch) is not None:
                limb.switch_bone, limb.switch_property = switch.bone, switch.property
                limb.switch_ik, limb.switch_fk = switch.ik, switch.fk
    for setting in character_map.settings:
        shown = group.settings.add()
        shown.bone, shown.property, shown.value = setting.bone, setting.property, float(setting.value)
        shown.kind = next(kind for kind, value in KINDS.items() if value is type(setting.value))


def clear_map(group: bpy.types.PropertyGroup) -> None:
    """Empty the properties of a map."""
    for name in ("title", *WORDS, "tags", "roles", "limbs", "settings", "root", "preset"):
        group.property_unset(name)


def role_named(group: bpy.types.PropertyGroup, role: str) -> bpy.types.PropertyGroup:
    """The properties of a role; those of all roles are added where there are none yet."""
    if not len(group.roles):
        show_map(group, CharacterMap(group.title, {}))
    return group.roles[role]


def _show_role(shown: bpy.types.PropertyGroup, name: str, character_map: CharacterMap, doubt: str) -> None:
    shown.name = name
    found = character_map.roles.get(name)
    keyed = character_map.keyed_bones(name)
    for number, bone in enumerate(character_map.bones(name) or ("",)):
        entry = shown.bones.add()
        entry.bone = bone  # its update makes the role the person's
        control = keyed[number] if number < len(keyed) else bone
        entry.keyed = control is not None
        entry.control = control if control not in (None, bone) else ""
        if found is not None and found.shares:
            entry.share = found.shares[number]
    shown.uneven = name in CHAINS and found is not None and bool(found.shares)
    shown.source = found.source if found is not None else "you"
    shown.confidence = found.confidence if found is not None else 1.0
    shown.doubt = doubt
    shown.left_alone = name in character_map.left_alone
    for point in character_map.soles.get(name, ()):
        shown.sole.add().place = point
    if name in character_map.rest_corrections:
        shown.corrected, shown.correction = True, character_map.rest_corrections[name]


def _ik_of(limb: bpy.types.PropertyGroup) -> IkControls:
    switch = None
    if limb.switch_bone and limb.switch_property:
        switch = Switch(
            limb.switch_bone, limb.switch_property, _rounded(limb.switch_ik), _rounded(limb.switch_fk)
        )
    return IkControls(limb.goal, limb.pole or None, limb.toe or None, switch)


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
