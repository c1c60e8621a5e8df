"""Nearest angles of chains of hinges."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from keymark.core.body.rotations import exponential, hinge, logarithm
from keymark.operators.bridge.rotation_modes import nearest_hinges

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
