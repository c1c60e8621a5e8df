"""Points of a character that key reduction holds: joints, ends and soles."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np

from ...arrays import Array, BoolArray
from ...feet.contacts import over_lowest
from ...keys.tolerances import FLOOR_M, NEAR_FLOOR_M, RESTING_M
from ...numerics.vectors import across, unit
from ..character import FINGER_ROLES, LIMBS, MIDDLE, Character
from ..character_motion import CharacterMotion
from ..maps.character_map import CharacterMap


class PointKind(Enum):
    """What a point is held for."""

    BODY = "body"  # the look of the motion
    END = "end"  # wrist or ankle: the same in IK and FK
    SOLE = "sole"  # it must neither slide nor pass the floor


@dataclass(frozen=True, eq=False)
class HeldPoint:
    """A point fixed to a bone with a role."""

    bone: str
    place: Array  # (3,) in the bone's axes from its head, in the armature's units
    kind: PointKind
    limb: str | None


def held_points(
    character: Character, character_map: CharacterMap, soles: Mapping[str, Array]
) -> tuple[HeldPoint, ...]:
    """The points that show how each bone with a role is placed and turned; soles (N, 3) are at rest."""
    found = []
    trunk = [character.bone(name) for role in MIDDLE for name in character_map.bones(role)]
    # Distance of the points that show how a bone of the trunk turns, in lengths from hips to head.
    size = 0.15 * float(np.ptp([bone.head for bone in trunk], axis=0).max()) if trunk else 0.0
    for place in size * np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]):
        found += [HeldPoint(bone.name, place, PointKind.BODY, None) for bone in trunk]
    # Twice that far along a finger's bone the tolerance holds its turn within some degrees.
    for bone in [character.bone(name) for role in FINGER_ROLES for name in character_map.bones(role)]:
        way = bone.tail - bone.head
        place = (2.0 * size * unit(way)) @ bone.rest[:3, :3]
        found.append(HeldPoint(bone.name, place, PointKind.BODY, None))
    for limb, roles in LIMBS.items():
        chain = [role for role in roles if role in character_map.roles]
        bones = [character.bone(str(character_map.bone(role))) for role in chain]
        length = 0.0
        for number, (role, bone) in enumerate(zip(chain, bones, strict=True)):
            last = number + 1 == len(bones)
            along = (bone.tail if last else bones[number + 1].head) - bone.head
            own = float(np.linalg.norm(along))
            if last and own > 1e-9:  # tails may lie anywhere: half of the part before is as good as any
                along = along * (0.5 * length / own)
            length = float(np.linalg.norm(along))
            end = bone.head + along
            kind = PointKind.END if role.split(".")[0] in ("hand", "foot") else PointKind.BODY
            places = [(bone.head, kind), (end, PointKind.BODY)]
            # This far off, in lengths of the bone, a point shows its turn about its own length.
            places.append((end + 0.3 * length * across(along), PointKind.BODY))
            places += [(point, PointKind.SOLE) for point in soles.get(role, ())]
            turn = bone.rest[:3, :3]
            found += [HeldPoint(bone.name, (place - bone.head) @ turn, kind, limb) for place, kind in places]
    return tuple(found)


# In meters for a character of the performer's size; smaller and larger ones have them in proportion.
SWITCH_M = 0.0008  # largest distance of wrists and ankles between IK and FK
LEAST_M = 0.0002  # of a limb's ends where it is all but straight: less would bring keys and no likeness
CARRIED_SHARE = 0.5  # share of the tolerance for a limb's root, and as much for elbow or knee on it


@dataclass(frozen=True, eq=False)
class ToleranceRules:
    """What tolerances follow from."""

    motion: CharacterMotion
    time_s: Array  # (F,) time of each frame [s]
    up: Array  # (3,) away from the floor, in the armature's axes
    general_m: float  # tolerance of the body, of a character of the performer's size as all of them [m]

    @property
    def body_m(self) -> float:
        """Tolerance of this character's body [m]."""
        return self.general_m * self.motion.size

    def of(self, point: HeldPoint, path: Array, shown: bool, ends_m: float) -> Array:
        """(F,) tolerance of a point on a path (F, 3) in the armature's axes [m].

        A point that is not `shown` is what a switch between IK and FK would show; `ends_m` is for wrists and
        ankles.
        """
        allowed = np.full(len(path), self.general_m)
        if point.kind is PointKind.END:
            allowed[:] = min(ends_m, self.general_m)
        if point.kind is PointKind.SOLE:
            allowed[over_lowest(path @ self.up, self.time_s) < NEAR_FLOOR_M * self.motion.size] = min(
                FLOOR_M, self.general_m
            )
        if shown and point.kind is not PointKind.BODY:
            allowed[self.resting(point.limb)] = min(RESTING_M, self.general_m)
        elif point.kind is PointKind.END:
            allowed[self.resting(point.limb)] = min(SWITCH_M, self.general_m)
        return allowed * self.motion.size

    def resting(self, limb: str | None) -> BoolArray:
        """(F,) whether the foot of a limb rests."""
        rests = np.zeros(len(self.time_s), dtype=bool)
        for rest in self.motion.rests:
            if rest.leg == limb:
                rests[rest.frames] = True
        return rests

    def reach_m(self, joints: tuple[Array, Array, Array], share: float = 1.0) -> Array:
        """(F,) error of a limb's length that moves elbow or knee by a share of the tolerance [m]."""
        root, middle, end = joints
        general_m, least_m = share * self.body_m, LEAST_M * self.motion.size
        line, length = unit(end - root), np.linalg.norm(end - root, axis=-1)
        along = ((middle - root) * line).sum(axis=-1)
        out = np.linalg.norm(np.cross(middle - root, line), axis=-1)
        longer = np.maximum(np.maximum(along, length - along), least_m)
        return np.asarray(np.clip(general_m * out / longer, min(least_m, general_m), general_m))

    def pole_m(self, joints: tuple[Array, Array, Array], distance_m: float) -> Array:
        """(F,) error of a pole that moves elbow or knee by the tolerance, or turns its limb by 0.04 rad [m].

        `distance_m` is that of the pole from elbow or knee.
        """
        root, middle, end = joints
        line = unit(end - root)
        out = np.linalg.norm(np.cross(middle - root, line), axis=-1)
        reach, least_m = out + distance_m, LEAST_M * self.motion.size
        return np.asarray(np.minimum(self.body_m * reach / np.maximum(out, least_m), 0.04 * reach))
