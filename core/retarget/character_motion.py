"""A motion as the character performs it: the poses of the bones that play a role, before any control."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from ..arrays import Array, BoolArray
from ..feet.contacts import Contact
from .character import ARM, LEG, Character, Similarity
from .maps.character_map import CharacterMap


@dataclass(frozen=True, eq=False)
class HandGoal:
    """Where a hand of the character belongs by what the performer's hand is near."""

    place_m: Array  # (F, 3) place of the wrist, canonical, before any way is taken off [m]
    share: Array  # (F,) how much it counts against the direction of the arm, 0 to 1
    floor_share: Array  # (F,) how much the floor counts in it, 0 to 1
    in_reach: BoolArray  # (F,) whether the arm reaches it without being stretched


@dataclass(frozen=True, eq=False)
class CharacterMotion:
    """Poses of the role bones in F frames, in the armature's space and units."""

    poses: Mapping[str, Array]  # (F, 4, 4) by name, of every bone with a role that is not left alone
    bends: Mapping[str, Array]  # (F, 3) by limb: from the line through its ends toward elbow or knee
    root: Array | None  # (F, 4, 4) posed matrix of the root bone; None where it stays at rest
    to_world: Similarity  # where the armature stands; as it does with `Placement.CHARACTER`
    rests: tuple[Contact, ...]  # rests of the planted feet; their places are the performer's
    soles: Mapping[str, Array]  # (N, 3) by role of foot and toe: its sole at rest, in the armature's space
    size: float  # the character's size: its legs' length over the performer's
    stance: Array = field(default_factory=lambda: np.eye(3))
    """(3, 3) from the armature's axes to canonical ones: Z up, facing -Y. *Canonical* places are in these
    axes and in meters, from the armature's origin."""
    facing: Array = field(default_factory=lambda: np.eye(3))
    """(3, 3) from directions of the performer's world to the character's; 1 with `Placement.PERFORMER`."""
    way_m: Array = field(default_factory=lambda: np.zeros(3))
    """(F, 3) or (3,) way over the ground that `RootMotion.IN_PLACE` took off, canonical [m]."""
    ground_m: Mapping[str, Array] = field(default_factory=lambda: MappingProxyType({}))
    """(F,) by leg: height of the ground under its foot, canonical [m]."""
    hands: Mapping[str, HandGoal] = field(default_factory=lambda: MappingProxyType({}))
    """Where hands belong, by side, of those that reach."""
    notes: tuple[str, ...] = ()  # what a person should know, in sentences without a full stop


UP_SNAP_DEG = 15.0  # a body leans by a few degrees at rest; an axis this near to its length is up


def find_stance(character: Character, character_map: CharacterMap) -> Array:
    """Rotation (3, 3) from the armature's axes to a stance with Z up, facing -Y, the character's left at +X.

    The identity where the map lacks the limbs that would tell.
    """
    found = {role: character_map.bone(role) for role in character_map.roles}
    joints = {role: character.bone(bone).head for role, bone in found.items() if bone in character.index}
    pairs = {
        part: (joints[f"{part}.L"], joints[f"{part}.R"])
        for part in (*LEG[:3], *ARM[1:])  # parts whose joints lie clearly to the sides
        if f"{part}.L" in joints and f"{part}.R" in joints
    }
    middle = {part: np.asarray(0.5 * (one + other)) for part, (one, other) in pairs.items()}
    left = _mean_direction([one - other for one, other in pairs.values()])
    heights = [middle[part] for part in ("foot", "shin", "thigh", "upper_arm") if part in middle]
    if len(heights) < 2 and "head" in joints:
        heights.append(joints["head"])
    up = _mean_direction([heights[-1] - heights[0]]) if len(heights) > 1 else None
    if left is None or up is None:
        return np.eye(3)
    up = _upright(up, middle)
    left = left - up * float(left @ up)
    if not np.linalg.norm(left) > 1e-9:
        return np.eye(3)
    # An axis this near to the line from side to side is that line.
    left = _snapped(left / np.linalg.norm(left), 3.0)
    left = left - up * float(left @ up)
    left /= np.linalg.norm(left)
    return np.stack([left, np.cross(up, left), up])


def _upright(up: Array, middle: Mapping[str, Array]) -> Array:
    """The axis that is up where the body's length, or a part of a bent body, is near one; else the length."""
    snapped = _snapped(up, UP_SNAP_DEG)
    trunk, *legs = (
        _mean_direction([middle[high] - middle[low]] if low in middle and high in middle else [])
        for low, high in (("thigh", "upper_arm"), ("foot", "thigh"), ("foot", "shin"), ("shin", "thigh"))
    )
    if snapped is not up or trunk is None or legs[0] is None:
        return snapped
    # Angle of the legs to the trunk from which a body sits, crouches or bows: its length is then not
    # upright.
    if float(trunk @ legs[0]) > np.cos(np.radians(30.0)):
        return up
    axis, near = _snapped(up, 90.0), np.cos(np.radians(UP_SNAP_DEG))
    return axis if any(part is not None and float(part @ axis) >= near for part in (trunk, *legs)) else up


def _mean_direction(ways: list[Array]) -> Array | None:
    """(3,) the mean of the directions of ways (3,); None where they have none."""
    units = [way / max(float(np.linalg.norm(way)), 1e-9) for way in ways]
    total = np.sum(units, axis=0) if units else np.zeros(3)
    length = float(np.linalg.norm(total))
    return np.asarray(total / length) if length > 1e-9 else None


def _snapped(direction: Array, within_deg: float) -> Array:
    """The axis nearest to a unit vector where it is near enough, else the vector."""
    largest = int(np.argmax(np.abs(direction)))
    axis = np.zeros(3)
    axis[largest] = np.sign(direction[largest])
    return axis if float(axis @ direction) >= np.cos(np.radians(within_deg)) else direction
