"""Points of a character that key reduction holds: joints, ends and soles."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np

from ...arrays import Array
from ...numerics.vectors import across
from ..character import Character
from ..maps.character_map import CharacterMap
from ..roles import LIMBS, MIDDLE

LEVER = 0.3
"""Distance of a point that shows a bone's turn about its own length, in lengths of the bone."""
END = 0.5
"""Length of a limb's last part, in lengths of the part before it."""
TRUNK = 0.15
"""Distance of the points that show how a bone of the trunk turns, in lengths from hips to head."""
LEAST_LENGTH = 1e-9


class PointKind(Enum):
    """What a point is held for."""

    BODY = "body"
    """The look of the motion."""
    END = "end"
    """Wrist or ankle: the same in IK and FK."""
    SOLE = "sole"
    """It must neither slide nor pass the floor."""


@dataclass(frozen=True, eq=False)
class HeldPoint:
    """A point fixed to a bone with a role."""

    bone: str
    place: Array
    """(3,) in the bone's axes from its head, in the armature's units."""
    kind: PointKind
    limb: str | None


def held_points(
    character: Character, character_map: CharacterMap, soles: Mapping[str, Array]
) -> tuple[HeldPoint, ...]:
    """The points that show how each bone with a role is placed and turned.

    Args:
        character: The character.
        character_map: Its map.
        soles: (N, 3) by role points of the soles at rest, in the armature's space.
    """
    return (*_trunk_points(character, character_map), *_limb_points(character, character_map, soles))


def _trunk_points(character: Character, character_map: CharacterMap) -> list[HeldPoint]:
    bones = [character.bone(name) for role in MIDDLE for name in character_map.bones(role)]
    size = TRUNK * float(np.ptp([bone.head for bone in bones], axis=0).max()) if bones else 0.0
    return [
        HeldPoint(bone.name, place, PointKind.BODY, None)
        for bone in bones
        for place in (np.zeros(3), np.array([size, 0.0, 0.0]), np.array([0.0, 0.0, size]))
    ]


def _limb_points(
    character: Character, character_map: CharacterMap, soles: Mapping[str, Array]
) -> list[HeldPoint]:
    found = []
    for limb, roles in LIMBS.items():
        chain = [role for role in roles if role in character_map.roles]
        bones = [character.bone(str(character_map.bone(role))) for role in chain]
        length = 0.0
        for number, (role, bone) in enumerate(zip(chain, bones, strict=True)):
            last = number + 1 == len(bones)
            along = (bone.tail if last else bones[number + 1].head) - bone.head
            own = float(np.linalg.norm(along))
            if last and own > LEAST_LENGTH:  # tails may lie anywhere: their direction is as good as any
                along = along * (END * length / own)
            length = float(np.linalg.norm(along))
            end = bone.head + along
            kind = PointKind.END if role.split(".")[0] in ("hand", "foot") else PointKind.BODY
            places = [(bone.head, kind), (end, PointKind.BODY)]
            places.append((end + LEVER * length * across(along), PointKind.BODY))
            places += [(point, PointKind.SOLE) for point in soles.get(role, ())]
            found += [HeldPoint(bone.name, _local(bone.rest, place), kind, limb) for place, kind in places]
    return found


def _local(rest: Array, place: Array) -> Array:
    return np.asarray((place - rest[:3, 3]) @ rest[:3, :3])
