"""Random poses show how controls act, and leave nothing behind."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from keymark.core.retarget.controls.control_channels import planned_controls
from keymark.core.retarget.maps.character_map import CharacterMap
from keymark.core.retarget.recognition.recognize import recognize
from keymark.core.take.conversion_settings import LimbKeys, RetargetOptions
from keymark.operators.bridge.character.probe_controls import ProbedControls, probe_controls
from keymark.operators.bridge.character.read_character import read_character

BOTH = RetargetOptions(arms=LimbKeys.BOTH, legs=LimbKeys.BOTH)


@pytest.fixture
def known(rigify: bpy.types.Object) -> CharacterMap:
    """The map of Rigify's basic human."""
    return recognize(read_character(rigify)).character_map


@pytest.fixture
def probed(rigify: bpy.types.Object, known: CharacterMap) -> ProbedControls:
    """Its controls."""
    return probe_controls(rigify, known, planned_controls(known, BOTH))


CARRIERS = {
    "torso": None,
    "spine_fk.002": "torso",
    "spine_fk.003": "spine_fk.002",
    "neck": "spine_fk.003",
    "head": "neck",
    "upper_arm_fk.L": "shoulder.L",
    "hand_fk.R": "forearm_fk.R",
    "thigh_fk.L": "torso",
    "foot_ik.L": None,
    "toe_ik.L": "foot_ik.L",
    "hand_ik.R": None,
    "thigh_ik_target.R": None,
}


def test_each_control_stands_in_its_space(probed: ProbedControls) -> None:
    names = [control.name for control in probed.controls]
    for name, carrier in CARRIERS.items():
        space = probed.controls[names.index(name)].space
        assert (names[space.carrier] if space.carrier >= 0 else None) == carrier
        assert (names[space.turner] if space.turner >= 0 else None) == carrier
        assert space.residual_rad < 1e-5
    assert not probed.controls[names.index("shin_fk.L")].space.movable  # it is connected
    assert probed.controls[names.index("hand_fk.L")].space.movable  # locks stop no keys
    assert probed.notes == ()


def test_hands_and_feet_follow_their_goals(rigify: bpy.types.Object, probed: ProbedControls) -> None:
    for goal, bone in (("hand_ik.L", "hand.L"), ("foot_ik.R", "foot.R"), ("toe_ik.L", "toe.L")):
        rest, own = (np.array(rigify.data.bones[name].matrix_local) for name in (goal, f"ORG-{bone}"))
        assert probed.offsets[goal] == pytest.approx(np.linalg.inv(rest) @ own, abs=2e-3)
    for pole, joint in (("thigh_ik_target.L", "ORG-shin.L"), ("upper_arm_ik_target.R", "ORG-forearm.R")):
        bones = rigify.data.bones
        apart = np.array(bones[pole].head_local - bones[joint].head_local)
        assert probed.poles[pole].distance == pytest.approx(float(np.linalg.norm(apart)), abs=1e-5)
        assert probed.poles[pole].offset_rad == pytest.approx(0.0, abs=1e-3)
    toe = next(control for control in probed.controls if control.name == "toe_ik.L")
    ankle, ball = (np.array(rigify.data.bones[name].head_local) for name in ("ORG-foot.L", "ORG-toe.L"))
    assert np.linalg.norm(toe.space.origin) == pytest.approx(np.linalg.norm(ball - ankle), abs=2e-3)


def test_nothing_is_left_behind(
    rigify: bpy.types.Object, known: CharacterMap, state: Callable[[bpy.types.Object], object]
) -> None:
    planned = planned_controls(known, BOTH)
    rigify.pose.bones["chest"].rotation_quaternion = (0.8, 0.3, 0.1, 0.2)
    rigify.pose.bones["thigh_parent.L"]["IK_parent"] = 3
    bpy.context.view_layer.update()
    before = state(rigify)
    probe_controls(rigify, known, planned)
    assert state(rigify) == before
    held = rigify.pose.bones["thigh_parent.L"]
    assert isinstance(held["IK_parent"], int) and isinstance(held["pole_vector"], bool)


def test_what_an_animator_left_posed_is_part_of_the_space(
    rigify: bpy.types.Object, known: CharacterMap, probed: ProbedControls
) -> None:
    rigify.pose.bones["root"].location = (0.5, 0.25, 0.0)
    bpy.context.view_layer.update()
    again = probe_controls(rigify, known, planned_controls(known, BOTH))
    for first, second in zip(probed.controls, again.controls, strict=True):
        if first.space.carrier < 0:
            moved = second.space.origin - first.space.origin
            assert moved[:2] == pytest.approx([0.5, 0.25], abs=1e-5)
