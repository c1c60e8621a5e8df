"""A character's rest pose as its roles see it, and the stage on which the performer stands where it does.

Joints are the heads of bones; tails, which importers put anywhere, are not believed before they are found to
meet the heads of children. The chain of the body is the logical one (hips, spine, neck, head; upper arm,
forearm, hand ...), whatever the armature's hierarchy: feet that hang on a root bone follow the shins.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, pairwise

import numpy as np

from ...arrays import Array
from ...body.fingers import palm_axes
from ...body.kinematics import SegmentMotion
from ...body.posture import turn_headings_rad, yaw_rotation
from ...body.skeleton import FINGERS, SIDES
from ...errors import InputError, shown
from ...feet.ground import Ground
from ..character import FINGER_ROLES, JOINTS, LIMBS, LONG_BONES, MIDDLE, Character
from ..character_motion import find_stance
from ..maps.character_map import CharacterMap
from ..maps.map_registry import check_map

SHORTEST_SHARE = 0.005  # least length of a long bone, as a share of the body's extent


@dataclass(frozen=True, eq=False)
class RestBone:
    """A bone that plays a role."""

    name: str
    role: str
    number: int  # its place in the role's chain, from 0
    carrier: int  # index of the bone that carries its joint; -1 for the hips
    head: Array  # (3,) its joint, canonical [m]


@dataclass(frozen=True, eq=False)
class RestBody:
    """The rest pose of a character's role bones."""

    character: Character
    character_map: CharacterMap
    stance: Array  # (3, 3) from the armature's axes to canonical ones
    bones: tuple[RestBone, ...]  # carriers before what they carry; the hips first

    @classmethod
    def of(cls, character: Character, character_map: CharacterMap) -> "RestBody":
        """The rest pose by a map.

        Raises:
            InputError: A role or a bone is missing, a bone plays two roles, or a limb has no length.
        """
        check_map(character_map, character)
        stance = find_stance(character, character_map)
        bones: list[RestBone] = []
        for role in (*MIDDLE, *chain.from_iterable(LIMBS.values()), *FINGER_ROLES):
            handless = role in FINGER_ROLES and f"hand.{role[-1]}" not in character_map.roles
            for number, name in enumerate(() if handless else character_map.bones(role)):
                played = next((bone.role for bone in bones if bone.name == name), None)
                if played is not None:
                    raise InputError(
                        f"character map {shown(character_map.title)} gives bone {shown(name)} for both "
                        f"{played} and {role}; a bone plays one role"
                    )
                carrier = _carrier(character, bones, role, name)
                head = character.scale * stance @ character.bone(name).head
                bones.append(RestBone(name, role, number, carrier, head))
        body = cls(character, character_map, stance, tuple(bones))
        extent = float(np.ptp([bone.head for bone in bones], axis=0).max())
        for limb in LIMBS:
            for role, below in pairwise(role for role in JOINTS[limb] if role in body.first):
                if not body.length_m(role, below) > SHORTEST_SHARE * extent:
                    raise InputError(
                        f"{character.name}: {bones[body.first[role]].name} ({role}) and "
                        f"{bones[body.first[below]].name} ({below}) begin at the same place; "
                        f"the bones of {limb} must have a length"
                    )
        return body

    @cached_property
    def first(self) -> Mapping[str, int]:
        """Index of the first bone of each role that is there."""
        return {bone.role: index for index, bone in reversed(list(enumerate(self.bones)))}

    @cached_property
    def last(self) -> Mapping[str, int]:
        """Index of the last bone of each role that is there."""
        return {bone.role: index for index, bone in enumerate(self.bones)}

    def joint(self, role: str) -> Array:
        """(3,) the joint of a role that is there, canonical [m]."""
        return self.bones[self.first[role]].head

    def is_moved(self, role: str) -> bool:
        """Whether a role is there and not left alone."""
        return role in self.first and role not in self.character_map.left_alone

    def length_m(self, role: str, below: str) -> float:
        """Distance of two roles' joints [m]."""
        return float(np.linalg.norm(self.joint(below) - self.joint(role)))

    @cached_property
    def leg_m(self) -> float:
        """Mean length of the legs, hip to ankle along the bones [m]."""
        return 0.5 * sum(self.length_m(*ends) for side in SIDES for ends in LONG_BONES[f"leg.{side}"])

    def middle(self, part: str) -> Array:
        """(3,) midpoint of the joints of a part on both sides, canonical [m]."""
        return np.asarray(0.5 * (self.joint(f"{part}.L") + self.joint(f"{part}.R")))

    def palm(self, side: str) -> Array | None:
        """(3, 3) axes of a hand by where its fingers begin, canonical; None of fewer than two."""
        starts = {one: self.joint(f"{one}.{side}") for one in FINGERS if f"{one}.{side}" in self.first}
        others = [start for finger, start in starts.items() if finger != FINGERS[0]]
        if not others or len(starts) < 2:
            return None
        first, last = (others[0], others[-1]) if len(others) > 1 else (starts[FINGERS[0]], others[0])
        return palm_axes(np.mean(others, axis=0) - self.joint(f"hand.{side}"), first - last, side)

    def tip(self, role: str) -> Array | None:
        """(3,) the end of a role's last bone: the farthest head of a child, else a tail that means something.

        None where neither is there.
        """
        if role not in self.last:
            return None
        index = self.character.index[self.bones[self.last[role]].name]
        bone = self.character.bones[index]
        scale = self.character.scale
        ends = [self.character.bones[child].head for child in self.character.children[index]]
        ends = [end for end in ends if np.linalg.norm(end - bone.head) * scale > SHORTEST_SHARE * self.leg_m]
        if not ends and self.character.tails_are_meant:
            ends = [bone.tail]
        if not ends:
            return None
        farthest = max(ends, key=lambda end: float(np.linalg.norm(end - bone.head)))
        return np.asarray(scale * self.stance @ farthest)


def _carrier(character: Character, bones: list[RestBone], role: str, name: str) -> int:
    """Index of the bone that carries a joint.

    Along a limb it is the one before. Where a limb or the neck begins, it is the bone of the trunk that the
    armature hangs it on, else the upper end of what is there below it.
    """
    if not bones or role in ("spine", "neck", "head"):
        return len(bones) - 1
    limb = next((roles for roles in LIMBS.values() if role in roles), (role, f"hand.{role[-1]}"))
    inner = [index for index, bone in enumerate(bones) if bone.role in limb]
    if inner:
        return inner[-1]
    trunk = {bone.name: index for index, bone in enumerate(bones) if bone.role in MIDDLE}
    above = character.bone(name).parent
    while above >= 0:
        if character.bones[above].name in trunk:
            return trunk[character.bones[above].name]
        above = character.bones[above].parent
    if role.startswith("thigh"):
        return 0
    return [index for index in trunk.values() if bones[index].role in ("hips", "spine")][-1]


def rest_notes(body: RestBody) -> tuple[str, ...]:
    """Sentences without a full stop on a rest pose that the map cannot mean."""
    roles = [(f"foot.{side}", f"toe.{side}") for side in SIDES]
    behind = [float(body.joint(toe)[1] - body.joint(foot)[1]) for foot, toe in roles if toe in body.first]
    if not behind or min(behind) <= 0.05 * body.leg_m:
        return ()
    doubt = f"The toes of '{body.character.name}' point backward by its character map; left and right may "
    return (doubt + "be mistaken for each other there",)


@dataclass(frozen=True, eq=False)
class Stage:
    """A performer, and the way from their world to the character's canonical space [m]."""

    source: SegmentMotion
    ground: Ground  # under the performer
    turn: Array  # (3, 3) from the world's axes to canonical ones, by where the performer faces at first
    under: Array  # (3,) the point of the performer's floor under the hips at the first frame [m]
    stand: Array  # (3,) the point of the floor under the resting character's hips, canonical [m]
    size: float  # the character's size: its legs' length over the performer's
    lift_m: float  # how much higher its ankles are over soles than a performer's of its size [m]

    def heights(self, heights_m: Array) -> Array:
        """Canonical heights (...) of world heights of the ground [m]."""
        return np.asarray(self.stand[2] + self.size * (heights_m - self.under[2]))


def find_stage(source: SegmentMotion, ground: Ground, stand: Array, leg_m: float, ankle_m: float) -> Stage:
    """The stage of a character that rests over a point (3,) of the floor, ankles `ankle_m` over soles [m]."""
    lengths = source.body.actor.segments_m
    own_m = 0.5 * sum(lengths[f"{part}.{side}"] for part in ("thigh", "shin") for side in "LR")
    size = leg_m / own_m
    hips = 0.5 * (source.start["thigh.L"][0] + source.start["thigh.R"][0])
    under = np.array([hips[0], hips[1], ground.height_m[0].min()])
    turn = yaw_rotation(-float(turn_headings_rad(source.turn["pelvis"][:1])[0]))
    return Stage(source, ground, turn, under, stand, size, ankle_m - size * ground.ankle_m)
