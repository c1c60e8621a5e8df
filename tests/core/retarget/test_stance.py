"""The stance of a character: up, facing and left, found from its roles."""

from dataclasses import replace

import numpy as np
import pytest
from _characters import plain_character, plain_map
from keymark.core.body.rotations import exponential
from keymark.core.retarget.character import Character
from keymark.core.retarget.character_motion import find_stance
from keymark.core.retarget.maps.character_map import CharacterMap


def test_a_lean_is_no_tilt_of_the_armature() -> None:
    character = plain_character(turn=exponential(np.radians([5.0, 0.0, 0.0])))
    assert np.array_equal(find_stance(character, plain_map(character)), np.eye(3))


def test_a_tilted_armature_is_found() -> None:
    turn = exponential(np.radians([40.0, 0.0, 0.0]))
    character = plain_character(turn=turn)
    stance = find_stance(character, plain_map(character))
    assert float((stance @ turn)[2, 2]) > np.cos(np.radians(3.0))


def test_a_map_without_limbs_leaves_the_axes() -> None:
    assert np.array_equal(find_stance(plain_character(), CharacterMap("X", {})), np.eye(3))


@pytest.mark.parametrize("y_up", [False, True])
def test_a_body_that_sits_at_rest_is_upright(y_up: bool) -> None:
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]) if y_up else np.eye(3)
    character = plain_character()
    knee_m = character.bone("thigh.L").head[2] - character.bone("shin.L").head[2]
    ahead = np.array([0.0, -knee_m, knee_m])
    bones = []
    for bone in character.bones:
        rest = bone.rest.copy()
        rest[:3, 3] += ahead * bone.name.startswith(("shin", "foot", "toe"))
        rest[:3] = turn @ rest[:3]
        bones.append(replace(bone, rest=rest))
    sitting = Character("Sitting", tuple(bones))
    assert np.allclose(find_stance(sitting, plain_map(sitting)), turn.T, atol=1e-9)
