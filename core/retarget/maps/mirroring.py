"""Character maps mirrored: the bones of one side found on the other, by their names and their places."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...body.mirror import other_side
from ..character import ROLES, Character
from ..recognition.bones import anatomy
from ..recognition.names import read_name
from ..recognition.symmetry import find_planes, mirrored
from .character_map import CharacterMap, RoleBones


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
