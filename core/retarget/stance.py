"""The stance of a character at rest: where its up, its front and its left lie among the armature's axes."""

import numpy as np

from ..arrays import Array
from .character import Character
from .character_map import CharacterMap


def find_stance(character: Character, character_map: CharacterMap) -> Array:
    """Rotation (3, 3) from the armature's axes to canonical ones: Z up, facing -Y, its left +X."""

    def head(role: str) -> Array:
        return character.bone(character_map.bones(role)[0]).head

    left = head("thigh.L") - head("thigh.R") + head("upper_arm.L") - head("upper_arm.R")
    up = head("upper_arm.L") + head("upper_arm.R") - head("thigh.L") - head("thigh.R")
    left = np.eye(3)[np.abs(left).argmax()] * np.sign(left[np.abs(left).argmax()])
    up = up - (up @ left) * left
    up = np.eye(3)[np.abs(up).argmax()] * np.sign(up[np.abs(up).argmax()])
    return np.stack([left, np.cross(up, left), up])
