"""Rotations, and forward kinematics with its Jacobians."""

import numpy as np
import pytest
from hypothesis import strategies as st
from keymark.core.body import rotations
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture

AXES = ((1.0, 0.0, 0.0), (0.0, 0.6, -0.8), (1.0, 1.0, 1.0))
ANGLES = (0.0, 1e-12, 1e-8, 0.99e-4, 1.01e-4, 1e-3, 0.5, 2.0, np.pi - 1e-3, np.pi - 1e-8)


@st.composite
def vectors(draw: st.DrawFn, longest: float = np.pi - 1e-6) -> np.ndarray:
    """Rotation vectors shorter than `longest`, of any size down to zero."""
    direction = np.array([draw(st.floats(-1.0, 1.0)) for _ in range(3)])
    length = np.linalg.norm(direction)
    if length < 1e-9:
        return np.zeros(3)
    return direction / length * draw(st.floats(0.0, longest) | st.floats(0.0, 1e-6))


def rotation_vector(axis: tuple[float, ...], angle: float) -> np.ndarray:
    """The rotation vector of an axis of any length and an angle."""
    return np.array(axis) / np.linalg.norm(axis) * angle


def test_a_quarter_turn_about_z_takes_x_to_y() -> None:
    turn = rotations.exponential(np.array([0.0, 0.0, np.pi / 2]))
    np.testing.assert_allclose(turn, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-15)


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("angle", ANGLES)
def test_the_logarithm_undoes_the_exponential(axis: tuple[float, ...], angle: float) -> None:
    vector = rotation_vector(axis, angle)
    np.testing.assert_allclose(rotations.logarithm(rotations.exponential(vector)), vector, atol=1e-9)


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("angle", ANGLES)
def test_the_right_jacobian_agrees_with_central_differences(axis: tuple[float, ...], angle: float) -> None:
    vector, step = rotation_vector(axis, angle), 1e-5
    base = rotations.exponential(vector)
    columns = [
        (
            rotations.logarithm(base.T @ rotations.exponential(vector + step * axis_step))
            - rotations.logarithm(base.T @ rotations.exponential(vector - step * axis_step))
        )
        / (2.0 * step)
        for axis_step in np.eye(3)
    ]
    np.testing.assert_allclose(rotations.right_jacobian(vector), np.stack(columns, axis=-1), atol=1e-8)


def test_batches_agree_with_single_rotations() -> None:
    batch = np.random.default_rng(0).normal(size=(2, 5, 3))
    whole, slope = rotations.exponential(batch), rotations.right_jacobian(batch)
    np.testing.assert_allclose(whole[1, 3], rotations.exponential(batch[1, 3]), rtol=1e-14)
    np.testing.assert_allclose(slope[1, 3], rotations.right_jacobian(batch[1, 3]), rtol=1e-12)
    np.testing.assert_allclose(rotations.logarithm(whole[:, 2]), rotations.logarithm(whole)[:, 2], rtol=1e-14)


def test_a_hinge_turns_about_its_axis() -> None:
    axis = np.array([0.0, -1.0, 0.0])
    turns = rotations.hinge(axis, np.array([0.0, 0.3, -2.0]))
    np.testing.assert_allclose(turns @ axis, np.broadcast_to(axis, (3, 3)), atol=1e-15)
    np.testing.assert_allclose(rotations.logarithm(turns), np.outer([0.0, 0.3, -2.0], axis), atol=1e-12)


def test_quaternions_are_scalar_first() -> None:
    half = np.sqrt(0.5)
    turn = rotations.exponential(np.array([np.pi / 2, 0.0, 0.0]))
    np.testing.assert_allclose(rotations.to_quaternions(turn), [half, half, 0.0, 0.0], atol=1e-15)
    batch = rotations.exponential(np.random.default_rng(1).normal(size=(4, 6, 3)))
    quaternions = rotations.to_quaternions(batch)
    assert quaternions.shape == (4, 6, 4)
    assert (quaternions[..., 0] >= 0.0).all()


def test_continuous_quaternions_never_jump_to_the_other_sign() -> None:
    angle = np.linspace(0.0, 4.0 * np.pi, 60)
    raw = rotations.to_quaternions(rotations.hinge(np.array([0.0, 0.6, 0.8]), angle))[:, None]
    smooth = rotations.continuous_quaternions(raw)
    assert np.abs(np.diff(smooth, axis=0)).max() < 0.2 < np.abs(np.diff(raw, axis=0)).max()
    np.testing.assert_allclose(np.abs(np.sum(smooth * raw, axis=-1)), 1.0, rtol=1e-12)
    np.testing.assert_array_equal(rotations.continuous_quaternions(raw[:1]), raw[:1])


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
def test_a_flexed_joint_moves_what_hangs_on_it_as_joints_do(side: str) -> None:
    length = BODY.actor.segments_m
    bent = posture_with(**{f"elbow__{side}__flexion": 90.0, f"knee__{side}__flexion": 90.0})
    forearm = place(bent, f"wrist.{side}") - place(bent, f"elbow.{side}")
    np.testing.assert_allclose(forearm, [0.0, -length[f"forearm.{side}"], 0.0], atol=1e-12)
    shin = place(bent, f"ankle.{side}") - place(bent, f"knee.{side}")
    np.testing.assert_allclose(shin, [0.0, length[f"shin.{side}"], 0.0], atol=1e-12)
    lifted = place(posture_with(**{f"girdle__{side}__elevation": 20.0}), f"shoulder.{side}")
    rise = 0.5 * length["shoulder_width"] * np.sin(np.radians(20.0))
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
