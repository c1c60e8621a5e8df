"""Forward kinematics and its Jacobians."""

import numpy as np
import pytest
from keymark.core.body import rotations
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture

BODY = Body(Actor.from_stature(1.75))
STEP = 1e-6


def posture_with(**degrees: float) -> Posture:
    """Rest, with some degrees of freedom (dots and dashes written as __) set in degrees."""
    vector = np.zeros(34)
    for name, value in degrees.items():
        vector[HUMAN.dof_names.index(name.replace("__", "."))] = np.radians(value)
    return Posture.from_vector(HUMAN, vector)


def place(posture: Posture, name: str) -> np.ndarray:
    return BODY.points(BODY.pose(posture))[HUMAN.point_names.index(name)]


@pytest.mark.parametrize("side", ["L", "R"])
def test_a_flexed_elbow_brings_the_hand_forward(side: str) -> None:
    bent = posture_with(**{f"elbow__{side}__flexion": 90.0})
    forearm = place(bent, f"wrist.{side}") - place(bent, f"elbow.{side}")
    np.testing.assert_allclose(forearm, [0.0, -BODY.actor.segments_m[f"forearm.{side}"], 0.0], atol=1e-12)


@pytest.mark.parametrize("side", ["L", "R"])
def test_a_flexed_knee_brings_the_foot_back(side: str) -> None:
    bent = posture_with(**{f"knee__{side}__flexion": 90.0})
    shin = place(bent, f"ankle.{side}") - place(bent, f"knee.{side}")
    np.testing.assert_allclose(shin, [0.0, BODY.actor.segments_m[f"shin.{side}"], 0.0], atol=1e-12)


@pytest.mark.parametrize("side", ["L", "R"])
def test_a_raised_girdle_lifts_the_shoulder(side: str) -> None:
    lifted = place(posture_with(**{f"girdle__{side}__elevation": 20.0}), f"shoulder.{side}")
    rise = 0.5 * BODY.actor.segments_m["shoulder_width"] * np.sin(np.radians(20.0))
    assert lifted[2] - place(Posture.rest(HUMAN), f"shoulder.{side}")[2] == pytest.approx(rise)


def test_segments_keep_their_lengths_in_every_posture() -> None:
    posture = Posture.rest(HUMAN, (20,)).plus(np.random.default_rng(0).normal(0.0, 1.0, (20, 34)))
    points = BODY.points(BODY.pose(posture))
    index = HUMAN.point_names.index
    for first, second, length in (
        ("shoulder.L", "elbow.L", "upper_arm.L"),
        ("elbow.R", "wrist.R", "forearm.R"),
        ("hip.R", "knee.R", "thigh.R"),
        ("knee.L", "ankle.L", "shin.L"),
        ("hip.L", "hip.R", "hip_width"),
    ):
        apart = np.linalg.norm(points[:, index(first)] - points[:, index(second)], axis=-1)
        np.testing.assert_allclose(apart, BODY.actor.segments_m[length], rtol=1e-12)


def test_the_root_moves_the_whole_body() -> None:
    posture = Posture.rest(HUMAN).plus(np.random.default_rng(1).normal(0.0, 0.5, 34))
    step = np.zeros(34)
    step[:3], step[3:6] = [0.3, -1.0, 0.2], [0.2, 0.5, -0.9]
    before, after = (BODY.points(BODY.pose(p)) for p in (posture, posture.plus(step)))
    turn = posture.rotations[0] @ rotations.exponential(step[3:6]) @ posture.rotations[0].T
    hips = posture.translation
    np.testing.assert_allclose(after, (before - hips) @ turn.T + hips + step[:3], atol=1e-12)


@pytest.mark.parametrize("seed", range(12))
def test_the_points_jacobian_agrees_with_central_differences_on_the_manifold(seed: int) -> None:
    posture = Posture.rest(HUMAN).plus(np.random.default_rng(seed).normal(0.0, 0.7, 34))
    plus, minus = (BODY.points(BODY.pose(posture.plus(s * STEP * np.eye(34)))) for s in (1.0, -1.0))
    numeric = np.moveaxis(plus - minus, 0, -1) / (2.0 * STEP)
    np.testing.assert_allclose(BODY.points_jacobian(BODY.pose(posture)), numeric, atol=1e-8)


@pytest.mark.parametrize("segment", [segment.name for segment in HUMAN.segments])
def test_the_jacobian_of_any_place_agrees_with_central_differences(segment: str) -> None:
    joint = next(s.joint for s in HUMAN.segments if s.name == segment)
    posture, local = Posture.rest(HUMAN).plus(np.full(34, 0.3)), np.array([0.05, -0.1, 0.2])
    plus, minus = (BODY.pose(posture.plus(s * STEP * np.eye(34))).place(joint, local) for s in (1.0, -1.0))
    pose = BODY.pose(posture)
    jacobian = pose.places_jacobian([joint], pose.place(joint, local)[None])[0]
    np.testing.assert_allclose(jacobian, (plus - minus).T / (2.0 * STEP), atol=1e-8)
