"""Character maps mirrored: the bones of one side found on the other, by their names and their places."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...body.mirror import other_side
from ..character import LIMBS, ROLES, Character
from ..recognition.bones import anatomy
from ..recognition.symmetry import find_planes, mirrored
from .character_map import CharacterMap, RoleBones

WORDS = (("Left", "Right"), ("left", "right"), ("LEFT", "RIGHT"), ("L", "R"), ("l", "r"), ("左", "右"))
"""How names tell the sides."""
Partner = Callable[[str | None], str | None]
"""The bone of the other side that mirrors a bone; None where there is none."""


def mirrored_map(
    character: Character, character_map: CharacterMap, from_side: str
) -> tuple[CharacterMap, tuple[str, ...]]:
    """Copy one side of a map to the other, with its controls.

    With the map come the roles of the other side for which no bone was found, which stay as they were.
    """
    given = {
        role: bones.bones for role, bones in character_map.roles.items() if role.endswith(f".{from_side}")
    }
    partner = _partners(character, {name for bones in given.values() for name in bones})
    roles, fk, ik = dict(character_map.roles), dict(character_map.fk), dict(character_map.ik)
    missing = []
    for role in ROLES:
        if role not in given:
            continue
        partners = tuple(name for name in map(partner, given[role]) if name is not None)
        if len(partners) < len(given[role]):
            missing.append(other_side(role))
            continue
        roles[other_side(role)] = RoleBones(partners, shares=character_map.roles[role].shares)
        fk.pop(other_side(role), None)
        keyed = character_map.fk.get(role, ())
        turning = tuple(map(partner, keyed))
        if keyed and [name is None for name in turning] == [name is None for name in keyed]:
            fk[other_side(role)] = turning
    for limb in LIMBS:
        controls = ik[limb].renamed(partner) if limb in ik and limb.endswith(from_side) else None
        if controls is not None:
            ik[other_side(limb)] = controls
    return replace(character_map, roles=roles, fk=fk, ik=ik), tuple(missing)


def _partners(character: Character, used: set[str]) -> Partner:
    """What finds the partner of a bone; none of those used, which are of the side that is mirrored.

    One whose name differs in the word for the side alone comes before one that only lies there.
    """
    bones = anatomy(character, np.arange(len(character.bones)))
    plane = next(find_planes(bones), None)

    def partner(name: str | None) -> str | None:
        if name is None or name not in character.index:
            return None
        named, own = _other_names(name), character.bone(name)
        ranks: dict[str, tuple[bool, float]] = {}
        for other in character.bones:
            off = ends = 0.0
            if plane is not None:
                off = float(np.linalg.norm(other.head - mirrored(own.head, *plane[:2])))
                ends = float(np.linalg.norm(other.tail - mirrored(own.tail, *plane[:2])))
            far = other.name not in named
            # Share of the character's extent by which a mirrored bone may lie off.
            lost = far and (plane is None or off > 0.03 * bones.size)
            if other.name != name and other.name not in used and not lost:
                ranks[other.name] = (far, off + ends)  # bones at one joint, as twist bones, differ in tails
        return min(ranks, key=lambda other: ranks[other], default=None)

    return partner


def _other_names(name: str) -> set[str]:
    """Names that differ from one in a word for a side alone, once."""
    found = set()
    for one, other in WORDS:
        for old, new in ((one, other), (other, one)):
            start = name.find(old)
            while start >= 0:
                found.add(name[:start] + new + name[start + len(old) :])
                start = name.find(old, start + 1)
    return found
