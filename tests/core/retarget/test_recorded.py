"""Motions on characters of several shapes, their keys and their figures, number by number."""

from dataclasses import astuple, replace

import numpy as np
import pytest
from _characters import plain_character, plain_map
from _controls import control_motion, quaternion_values, with_ik
from _performances import performance, quality, shaped, solved, source_joints, stepping, with_hands
from _recorded import assert_recorded
from _varied import nameless, varied
from keymark.core.arrays import Array
from keymark.core.body.posture import turned_and_shifted
from keymark.core.body.rotations import hinge
from keymark.core.keys.hermite import Spline
from keymark.core.progress import run
from keymark.core.retarget.character import FINGER_ROLES, Character
from keymark.core.retarget.character_motion import find_stance
from keymark.core.retarget.controls.control_motion import dense_controls
from keymark.core.retarget.controls.point_tolerances import ToleranceRules
from keymark.core.retarget.controls.reduction import reduce_controls
from keymark.core.retarget.quality import direction_errors_deg
from keymark.core.retarget.recognition.recognize import recognize
from keymark.core.retarget.solve.feet import performer_ground
from keymark.core.take.conversion_settings import LimbKeys, RetargetOptions

FRAMES = 60
UP = np.array([0.0, 0.0, 1.0])


def wider(name: str, place: Array) -> Array:
    """Legs 7 cm farther out, arms 6 cm farther in."""
    leg = name.startswith(("thigh", "shin", "foot", "toe"))
    arm = name.startswith(("upper_arm", "forearm", "hand", "finger"))
    return place + [np.sign(place[0]) * (0.07 * leg - 0.06 * arm), 0.0, 0.0]


SHAPES = {
    "plain": lambda: shaped(lambda _, place: place),
    "hanging": lambda: shaped(lambda _, place: place, arms_down_deg=80.0, roll_rad=0.7),
    "bare": lambda: shaped(lambda _, place: place, without=("toe", "shoulder", "chest", "spine", "finger")),
    "wide": lambda: shaped(wider, scale=0.01),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_a_performance_on_a_character(shape: str) -> None:
    character, known = SHAPES[shape]()
    body, posture = stepping()
    raised = turned_and_shifted(posture[:FRAMES], 0.4, np.array([0.3, -0.2, 0.12]))
    for number, source in enumerate((performance(body, posture[:FRAMES]), performance(body, raised))):
        motion = solved(character, known, source)
        assert_recorded(f"solved {shape} {number}", *(motion.poses[name] for name in sorted(motion.poses)))
        figures = astuple(quality(character, known, source, motion))
        assert_recorded(f"quality {shape} {number}", [one for one in figures if isinstance(one, float)])
        ground = performer_ground(source)
        assert_recorded(f"ground {number}", ground.height_m, [ground.ankle_m])


@pytest.mark.parametrize("height", [0.75, 1.03, 1.3])
def test_hands_at_several_heights(height: float) -> None:
    character, known = SHAPES["wide"]()
    source = with_hands(np.array([0.12, -0.22, height]), np.array([-0.04, -0.3, height + 0.1]))
    motion = solved(character, known, source)
    assert_recorded(f"hands {height}", *(motion.poses[name] for name in sorted(motion.poses)))
    errors = direction_errors_deg(source_joints(source), source_joints(source), [("upper_arm.L", "hand.L")])
    assert np.abs(errors).max() < 1e-4


@pytest.mark.parametrize("keys", list(LimbKeys))
def test_few_keys(keys: LimbKeys) -> None:
    character = plain_character()
    known, options = with_ik(plain_map(character)), RetargetOptions(arms=keys, legs=keys)
    body, posture = stepping()
    source = performance(body, posture[:FRAMES])
    motion = solved(character, plain_map(character), source)
    wanted = control_motion(character, known, motion, options)
    times = 1.0 + np.arange(FRAMES)
    rules = ToleranceRules(motion, source.time_s, UP, 0.005)
    keyed = run(reduce_controls(wanted, times, rules, quaternion_values))
    count = sum(
        len(held.keys) for one in keyed for held in (one.rotation, one.location) if isinstance(held, Spline)
    )
    # Keys are taken one after the other: another machine's rounding moves a few of 237.
    assert_recorded(f"keys {keys.name}, count", [count], share=0.04)
    dense = dense_controls(wanted, quaternion_values)
    channels = [held for one in dense for held in (one.rotation, one.location) if held is not None]
    assert_recorded(f"keys {keys.name}", *channels)


def tilted(character: Character, angle_deg: float) -> Character:
    """The character leaning in its armature."""
    turn = np.eye(4)
    turn[:3, :3] = hinge(np.array([0.8, 0.6, 0.0]), np.radians(angle_deg))
    bones = [replace(bone, rest=turn @ bone.rest, tail=turn[:3, :3] @ bone.tail) for bone in character.bones]
    return replace(character, bones=tuple(bones))


def test_confidences_of_bodies_drawn_at_random() -> None:
    carried: list[int] = []
    for seed in range(12):
        for words, character in (("named", varied(seed)), ("nameless", nameless(varied(seed)))):
            found = recognize(character.character).character_map
            roles = found.roles
            body = [bones for role, bones in sorted(roles.items()) if role not in FINGER_ROLES]
            sure = [[bones.confidence, len(bones.bones), *bones.shares] for bones in body]
            assert_recorded(f"recognized {words} {seed}", *sure)
            carried += [len(each) for each in character.character.children]
            stances = [find_stance(tilted(character.character, deg), found) for deg in (0.0, 2.5, 20.0)]
            assert_recorded(f"stance {words} {seed}", *stances)
    assert_recorded("children", carried)
