"""How a character stands in its armature's space: which way is up, and where it faces."""

import numpy as np

from ..arrays import Array
from .character import Character
from .maps.character_map import CharacterMap
from .roles import ARM, LEG

UP_SNAP_DEG = 15.0
"""A body leans by a few degrees at rest; an axis this near to its length is up."""
BENT_DEG = 30.0
"""Angle of the legs to the trunk from which a body sits, crouches or bows: its length is then not upright."""
SIDE_SNAP_DEG = 3.0
"""An axis this near to the line from side to side is that line."""
PAIRS = (*LEG[:3], *ARM[1:])
"""Parts whose joints lie clearly to the sides."""


def find_stance(character: Character, character_map: CharacterMap) -> Array:
    """Rotation from the armature's axes to a stance with Z up, facing -Y, the character's left at +X.

    Returns:
        (3, 3); `rotation @ point` turns a point of the armature's space. The identity where the map lacks the
        limbs that would tell.
    """
    left = _sideways(character, character_map)
    up = _upward(character, character_map)
    if left is None or up is None:
        return np.eye(3)
    up = _upright(up, character, character_map)
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
    parts = ("foot", "shin", "thigh", "upper_arm")
    middles = [place for part in parts if (place := _middle(character, character_map, part)) is not None]
    head = _joint(character, character_map, "head")
    if len(middles) < 2 and head is not None:
        middles.append(head)
    return _mean_direction([middles[-1] - middles[0]]) if len(middles) > 1 else None


def _upright(up: Array, character: Character, character_map: CharacterMap) -> Array:
    """The axis that is up where the body's length, or a part of a bent body, is near one; else the length."""
    snapped = _snapped(up, UP_SNAP_DEG)
    trunk, *legs = (
        _between(character, character_map, *parts)
        for parts in (("thigh", "upper_arm"), ("foot", "thigh"), ("foot", "shin"), ("shin", "thigh"))
    )
    if snapped is not up or trunk is None or legs[0] is None:
        return snapped
    if float(trunk @ legs[0]) > np.cos(np.radians(BENT_DEG)):
        return up
    axis = _snapped(up, 90.0)
    near = [
        part
        for part in (trunk, *legs)
        if part is not None and float(part @ axis) >= np.cos(np.radians(UP_SNAP_DEG))
    ]
    return axis if near else up


def _between(character: Character, character_map: CharacterMap, low: str, high: str) -> Array | None:
    """Direction from the middle of a part's two joints to that of another's."""
    middles = [_middle(character, character_map, part) for part in (low, high)]
    if middles[0] is None or middles[1] is None:
        return None
    return _mean_direction([middles[1] - middles[0]])


def _middle(character: Character, character_map: CharacterMap, part: str) -> Array | None:
    left, right = (_joint(character, character_map, f"{part}.{side}") for side in "LR")
    return None if left is None or right is None else np.asarray(0.5 * (left + right))


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
