"""Character maps mirrored: the bones of one side found on the other, by their names and their places."""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array
from ...body.skeleton import SIDES
from ..character import Character
from ..roles import LIMBS, MIDDLE, ROLES
from .character_map import CharacterMap, IkControls, RoleBones, Switch

WORDS = (("Left", "Right"), ("left", "right"), ("LEFT", "RIGHT"), ("L", "R"), ("l", "r"), ("左", "右"))
"""How names tell the sides."""
NEAR = 0.03
"""Share of the character's extent by which a mirrored bone may lie off."""
LOOSE, REFINEMENTS = 0.1, 3
"""The same while the plane between the sides is sought, and how often it is fitted to what was found."""
ALONG_AXIS = np.cos(np.radians(5.0))
"""Cosine of the angle within which the sides are taken to lie along an axis of the armature."""


@dataclass(frozen=True, eq=False)
class _Sides:
    """A character whose sides are told apart."""

    character: Character
    origin: Array
    """(3,) a point of the plane between the sides."""
    normal: Array
    """(3,) unit vector across it."""
    near: float
    """Largest distance of partners from each other's mirrored place."""
    used: Collection[str]
    """Bones of the side that is mirrored, which no bone has for a partner."""

    def mirrored(self, point: Array) -> Array:
        """(3,) a point's mirrored place."""
        return np.asarray(point - 2.0 * self.normal * float((point - self.origin) @ self.normal))

    def partner(self, name: str | None) -> str | None:
        """The bone of the other side that mirrors a bone; None where there is none.

        One whose name differs in the word for the side alone comes before one that only lies there.
        """
        if name is None or name not in self.character.index:
            return None
        bone, named = self.character.bone(name), _other_names(name)
        head, tail = self.mirrored(bone.head), self.mirrored(bone.tail)
        best: tuple[bool, float] | None = None
        found = None
        for other in self.character.bones:
            off = float(np.linalg.norm(other.head - head))
            far = other.name not in named
            if other.name == name or other.name in self.used or (far and off > self.near):
                continue
            # Bones at one joint, as twist bones are, differ in their tails.
            rank = far, off + float(np.linalg.norm(other.tail - tail))
            if best is None or rank < best:
                best, found = rank, other.name
        return found


def mirrored_map(
    character: Character, character_map: CharacterMap, from_side: str
) -> tuple[CharacterMap, tuple[str, ...]]:
    """Copy one side of a map to the other, with its controls.

    Args:
        character: The character.
        character_map: Its map.
        from_side: `L` or `R`.

    Returns:
        The map, and the roles of the other side for which no bone was found, which stay as they were.
    """
    given = {role: character_map.bones(role) for role in ROLES if role.endswith(f".{from_side}")}
    sides = _sides(character, character_map, given)
    if sides is None:
        return character_map, tuple(_other(role) for role, bones in given.items() if bones)
    roles, fk, ik = dict(character_map.roles), dict(character_map.fk), dict(character_map.ik)
    missing = []
    for role, bones in given.items():
        partners = tuple(name for name in map(sides.partner, bones) if name is not None)
        if not bones or len(partners) < len(bones):
            missing += [_other(role)] if bones else []
            continue
        roles[_other(role)] = RoleBones(partners, shares=character_map.roles[role].shares)
        fk.pop(_other(role), None)
        keyed = character_map.fk.get(role, ())
        controls = tuple(map(sides.partner, keyed))
        if keyed and all(
            (own is None) == (other is None) for own, other in zip(keyed, controls, strict=True)
        ):
            fk[_other(role)] = controls
    for limb in LIMBS:
        mirrored = _mirrored_controls(sides, ik[limb]) if limb in ik and limb.endswith(from_side) else None
        if mirrored is not None:
            ik[_other(limb)] = mirrored
    return replace(character_map, roles=roles, fk=fk, ik=ik), tuple(missing)


def _other(role: str) -> str:
    """The same role or limb of the other side."""
    part, _, side = role.partition(".")
    return f"{part}.{next(other for other in SIDES if other != side)}"


def _sides(
    character: Character, character_map: CharacterMap, given: dict[str, tuple[str, ...]]
) -> _Sides | None:
    """The plane between the sides, along the trunk, across which the given bones lie; None without bones."""
    used = dict.fromkeys(name for bones in given.values() for name in bones if name in character.index)
    middle = [character_map.bone(role) for role in MIDDLE]
    trunk = [character.bone(name).head for name in middle if name is not None and name in character.index]
    others = [bone.head for bone in character.bones if bone.name not in used]
    if not used or not trunk or not others:
        return None
    origin = np.mean(trunk, axis=0)
    across = np.mean([character.bone(name).head for name in used], axis=0) - origin
    up = trunk[-1] - trunk[0]
    across = across - up * float(across @ up) / max(float(up @ up), 1e-12)
    across = across / max(float(np.linalg.norm(across)), 1e-12)
    heads = np.array([character.bone(name).head for name in used])
    size = float(np.ptp(np.concatenate([heads, others]), axis=0).max())
    for _ in range(REFINEMENTS):
        across, origin = _fitted(heads, np.array(others), origin, across, LOOSE * size)
    nearest = np.eye(3)[int(np.argmax(np.abs(across)))]
    normal = nearest if abs(float(across @ nearest)) > ALONG_AXIS else across
    return _Sides(character, origin, normal, NEAR * size, used)


def _fitted(given: Array, others: Array, origin: Array, normal: Array, near: float) -> tuple[Array, Array]:
    """Normal and origin of the plane between given points and those that they nearly mirror."""
    mirrored = given - 2.0 * ((given - origin) @ normal)[:, None] * normal
    distance = np.linalg.norm(mirrored[:, None] - others[None], axis=2)
    partner, found = others[np.argmin(distance, axis=1)], distance.min(axis=1) < near
    apart = np.sum((given - partner)[found], axis=0)
    length = float(np.linalg.norm(apart))
    if length <= near:
        return normal, origin
    return apart / length, np.mean(0.5 * (given + partner)[found], axis=0)


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


def _mirrored_controls(sides: _Sides, controls: IkControls) -> IkControls | None:
    """The other limb's controls; None where it has no goal."""
    goal = sides.partner(controls.goal)
    if goal is None:
        return None
    switch = controls.switch
    if switch is not None:
        bone = sides.partner(switch.bone)
        switch = None if bone is None else Switch(bone, switch.property, switch.ik, switch.fk)
    return IkControls(goal, sides.partner(controls.pole), sides.partner(controls.toe), switch)
