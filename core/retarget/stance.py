"""How a character stands in its armature's space: which way is up, and where it faces."""

import numpy as np

from ..arrays import Array
from .character import Character
from .maps.character_map import CharacterMap
from .roles import ARM, LEG

UP_SNAP_DEG = 15.0
"""A body leans by a few degrees at rest; an axis this near to its length is up."""
SIDE_SNAP_DEG = 3.0
"""An axis this near to the line from side to side is that line."""
PAIRS = (*LEG[:3], *ARM[1:])
"""Parts whose joints lie clearly to the sides."""


def find_stance(character: Character, character_map: CharacterMap) -> Array:
    """Rotation from the armature's axes to a stance with Z up, facing -Y, the character's left at +X.

    Args:
        character: Its bones at rest.
        character_map: Its roles, of which legs and arms are looked at.

    Returns:
        (3, 3); `rotation @ point` turns a point of the armature's space. The identity where the map lacks the
        limbs that would tell.
    """
    left = _sideways(character, character_map)
    up = _upward(character, character_map)
    if left is None or up is None:
        return np.eye(3)
    up = _snapped(up, UP_SNAP_DEG)
    left = left - up * float(left @ up)
    if not np.linalg.norm(left) > 1e-9:
        return np.eye(3)
    left = _snapped(left / np.linalg.norm(left), SIDE_SNAP_DEG)
    left = left - up * float(left @ up)
    left /= np.linalg.norm(left)
    return np.stack([left, np.cross(up, left), up])


def _sideways(character: Character, character_map: CharacterMap) -> Array | None:
    """Mean direction from right joints to their left counterparts."""
    found = []
    for part in PAIRS:
        left, right = (
            _joint(character, character_map, f"{part}.L"),
            _joint(character, character_map, f"{part}.R"),
        )
        if left is not None and right is not None and np.linalg.norm(left - right) > 1e-9:
            found.append((left - right) / np.linalg.norm(left - right))
    return _mean_direction(found)


def _upward(character: Character, character_map: CharacterMap) -> Array | None:
    """Direction from the middle of the feet to that of the shoulder joints, or as far up as is known."""
    middles = []
    for part in ("foot", "shin", "thigh", "upper_arm"):
        joints = [_joint(character, character_map, f"{part}.{side}") for side in "LR"]
        if joints[0] is not None and joints[1] is not None:
            middles.append(0.5 * (joints[0] + joints[1]))
    head = _joint(character, character_map, "head")
    if len(middles) < 2 and head is not None:
        middles.append(head)
    return _mean_direction([middles[-1] - middles[0]]) if len(middles) > 1 else None


def _joint(character: Character, character_map: CharacterMap, role: str) -> Array | None:
    bone = character_map.bone(role)
    return character.bone(bone).head if bone is not None and bone in character.index else None


def _mean_direction(directions: list[Array]) -> Array | None:
    total = np.sum(directions, axis=0) if directions else np.zeros(3)
    length = float(np.linalg.norm(total))
    return np.asarray(total / length) if length > 1e-9 else None


def _snapped(direction: Array, within_deg: float) -> Array:
    """The axis nearest to a unit vector where it is near enough, else the vector."""
    largest = int(np.argmax(np.abs(direction)))
    axis = np.zeros(3)
    axis[largest] = np.sign(direction[largest])
    return axis if float(axis @ direction) >= np.cos(np.radians(within_deg)) else direction
