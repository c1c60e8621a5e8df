"""Rotations as values of channels, as Blender itself reads them, and the hinges nearest to rotations."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from keymark.core.body.rotations import exponential, hinge, logarithm
from keymark.operators.bridge.rotation_modes import nearest_hinges, rotation_values
from mathutils import Euler, Quaternion

ORDERS = ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"]


def matrix_of(values: np.ndarray, mode: str) -> np.ndarray:
    """The rotation that Blender makes of a channel's values."""
    if mode == "QUATERNION":
        return np.array(Quaternion(values).to_matrix())
    if mode == "AXIS_ANGLE":
        return np.array(Quaternion(values[1:], values[0]).to_matrix())
    return np.array(Euler(values, mode).to_matrix())


@pytest.mark.parametrize("mode", ["QUATERNION", "AXIS_ANGLE", *ORDERS])
def test_blender_reads_the_same_rotation_from_the_values(mode: str) -> None:
    rotation = exponential(np.random.default_rng(1).normal(0.0, 1.5, (50, 3)))
    shown = np.stack([matrix_of(values, mode) for values in rotation_values(rotation, mode)])
    assert shown == pytest.approx(rotation, abs=1e-6)


@pytest.mark.parametrize("mode", ["QUATERNION", "AXIS_ANGLE", *ORDERS])
def test_two_full_turns_have_no_jump(mode: str) -> None:
    angles = np.linspace(0.0, 4.0 * np.pi, 200)
    axis = {"QUATERNION": 0, "AXIS_ANGLE": 2}.get(mode, "XYZ".index(mode[0]) if mode in ORDERS else 0)
    rotation = exponential(angles[:, None] * np.eye(3)[axis])
    steps = np.abs(np.diff(rotation_values(rotation, mode), axis=0))
    # From rest, axis and angle may take the axis at once; after that nothing moves faster than the turn.
    assert steps[1:].max() < 1.5 * (angles[1] - angles[0])


@pytest.mark.parametrize("mode", ORDERS)
def test_euler_angles_pass_the_pole_without_a_jump(mode: str) -> None:
    middle = "XYZ".index(mode[1])
    angles = np.linspace(0.2, np.pi - 0.2, 60)
    rotation = exponential(angles[:, None] * np.eye(3)[middle])
    values = rotation_values(rotation, mode)
    assert np.abs(np.diff(values, axis=0)).max() < 1.5 * (angles[1] - angles[0])
    assert values[:, middle] == pytest.approx(angles, abs=1e-6)


def test_a_rotation_without_angle_keeps_the_axis_before() -> None:
    angles = np.linspace(0.5, -0.5, 11)
    values = rotation_values(exponential(angles[:, None] * np.array([0.6, 0.0, 0.8])), "AXIS_ANGLE")
    assert values[:, 1:] == pytest.approx(np.tile([0.6, 0.0, 0.8], (11, 1)), abs=1e-9)
    assert values[:, 0] == pytest.approx(angles, abs=1e-9)


X, Y = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
ANGLES = st.floats(-np.pi + 1e-6, np.pi - 1e-6)


@given(ANGLES, ANGLES)
@settings(deadline=None, max_examples=60)
def test_two_hinges_within_reach_are_exact(first: float, second: float) -> None:
    rotation = hinge(X, np.array(first)) @ hinge(Y, np.array(second))
    found = nearest_hinges([X, Y], rotation)
    again = hinge(X, np.array(found[0])) @ hinge(Y, np.array(found[1]))
    assert again == pytest.approx(rotation, abs=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_beyond_reach_no_other_angles_are_nearer(seed: int) -> None:
    rotation = exponential(np.random.default_rng(seed).normal(0.0, 0.6, 3))
    first, second = nearest_hinges([X, Y], rotation)
    found = np.linalg.norm(logarithm((hinge(X, np.array(first)) @ hinge(Y, np.array(second))).T @ rotation))
    grid = np.linspace(-np.pi, np.pi, 181)
    chains = hinge(X, grid)[:, None] @ hinge(Y, grid)[None, :]
    distances = np.linalg.norm(logarithm(np.swapaxes(chains, -1, -2) @ rotation), axis=-1)
    assert found <= distances.min() + 1e-9
    assert found > 1e-3
