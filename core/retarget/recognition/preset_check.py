"""A preset's map held against what names and shape say."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...arrays import Array
from ...files.json_file import shown
from ...text import Sentence
from ..character import Character
from ..maps.character_map import CharacterMap, IkControls, RoleBones
from ..roles import CHAINS, REQUIRED, ROLES
from .figure import Figure
from .refusals import HANDS_ABOVE, LEAST_UPRIGHT

AGREED, UNSEEN, AGAINST = 0.99, 0.9, 0.6
"""Confidence of a preset's role that shape confirms, does not see, and contradicts."""
SAME_JOINT = 0.03
"""Heads this near to each other, in sizes, are one joint."""


def merged_with_preset(
    character: Character, preset: CharacterMap, roles: Mapping[str, RoleBones], figure: Figure
) -> tuple[CharacterMap, list[str]]:
    """The preset's map with its roles held against the figure, and what is doubtful about them.

    Args:
        character: The character.
        preset: The preset's map with the character's names.
        roles: What names and shape say.
        figure: The figure.
    """
    own = preset
    found: list[str] = []
    if _neck_carries_arms(character, own):
        own = _with_trunk_of(own, roles)
    near = SAME_JOINT * figure.frame.bones.size
    merged: dict[str, RoleBones] = {}
    for role in ROLES:
        given, seen = own.roles.get(role), roles.get(role)
        if given is None:
            if seen is not None and not _taken(own, seen):
                merged[role] = seen
        elif seen is None or role in CHAINS:
            merged[role] = replace(given, confidence=UNSEEN if seen is None else AGREED)
        elif np.linalg.norm(_head(character, given) - _head(character, seen)) < near:
            merged[role] = replace(given, confidence=AGREED)
        else:
            merged[role] = replace(given, confidence=AGAINST)
            found.append(
                Sentence(
                    "{role} is doubtful: {bone} was chosen by the names of {preset}, and by its place "
                    "{other} fits better",
                    role=role,
                    bone=shown(given.bones[0]),
                    preset=preset.title,
                    other=shown(seen.bones[0]),
                )
            )
    return replace(own, roles=merged), found


def stands_upright(character: Character, character_map: CharacterMap) -> bool:
    """Whether a map has all roles that a character must have, on a body that stands upright on its legs."""
    if any(role not in character_map.roles for role in REQUIRED):
        return False
    shoulder, hip, ankle, hand = (
        np.mean([_head(character, character_map.roles[f"{part}.{side}"]) for side in "LR"], axis=0)
        for part in ("upper_arm", "thigh", "foot", "hand" if "hand.L" in character_map.roles else "forearm")
    )
    leg, trunk = hip - ankle, shoulder - hip
    lengths = float(np.linalg.norm(leg)), float(np.linalg.norm(trunk))
    if not min(lengths) > 0.0 or float(leg @ trunk) < LEAST_UPRIGHT * lengths[0] * lengths[1]:
        return False
    return float((hand - ankle) @ leg) > HANDS_ABOVE * lengths[0] ** 2


def with_confidence(roles: Mapping[str, RoleBones], confidence: float) -> dict[str, RoleBones]:
    """The roles with one confidence for all."""
    return {role: replace(bones, confidence=confidence) for role, bones in roles.items()}


def swapped_sides(character_map: CharacterMap) -> CharacterMap:
    """The map with left and right exchanged."""
    roles = {_other_side(role): bones for role, bones in character_map.roles.items()}
    fk = {_other_side(role): bones for role, bones in character_map.fk.items()}
    ik: dict[str, IkControls] = {_other_side(limb): those for limb, those in character_map.ik.items()}
    return replace(character_map, roles={role: roles[role] for role in ROLES if role in roles}, fk=fk, ik=ik)


def _other_side(role: str) -> str:
    part, dot, side = role.partition(".")
    return part + dot + {"L": "R", "R": "L"}.get(side, "")


def _head(character: Character, role: RoleBones) -> Array:
    return character.bone(role.bones[0]).head


def _taken(character_map: CharacterMap, role: RoleBones) -> bool:
    """Whether another role of the map has one of the bones."""
    taken = {bone for other in character_map.roles.values() for bone in other.bones}
    return not taken.isdisjoint(role.bones)


def _neck_carries_arms(character: Character, character_map: CharacterMap) -> bool:
    """Whether a bone of the neck carries an upper arm although its name does not say neck."""
    arm = character_map.bone("upper_arm.L")
    if arm is None:
        return False
    above = character.index[arm]
    while above >= 0:
        name = character.bones[above].name
        if name in character_map.bones("neck") and "neck" not in name.casefold():
            return True
        above = character.bones[above].parent
    return False


def _with_trunk_of(character_map: CharacterMap, roles: Mapping[str, RoleBones]) -> CharacterMap:
    """The map with spine, neck and head as names and shape say."""
    kept = {role: bones for role, bones in character_map.roles.items() if role not in (*CHAINS, "head")}
    seen = {role: roles[role] for role in (*CHAINS, "head") if role in roles}
    return replace(character_map, roles={**kept, **seen})
