"""Rotations: exponential, logarithm, their Jacobians, quaternions."""

import numpy as np
import pytest
from hypothesis import strategies as st
from keymark.core.body import rotations

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
