"""Postures: the contract of `plus` and `minus`, vectors and batches."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.body import rotations
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture


def random_posture(seed: int, batch: tuple[int, ...] = (), spread: float = 0.8) -> Posture:
    """Postures away from rest in every degree of freedom."""
    return Posture.rest(HUMAN, batch).plus(np.random.default_rng(seed).normal(0.0, spread, (*batch, 34)))


def assert_same(first: Posture, second: Posture, tolerance: float = 1e-12) -> None:
    np.testing.assert_allclose(first.translation, second.translation, atol=tolerance)
    np.testing.assert_allclose(first.rotations, second.rotations, atol=tolerance)
    np.testing.assert_allclose(first.angles, second.angles, atol=tolerance)


@pytest.mark.parametrize("size", [0.0, 1e-12, 1e-8, 1e-3, 0.5, 1.5, np.pi - 1e-6])
@pytest.mark.parametrize("seed", range(3))
def test_minus_finds_the_step_that_plus_took(size: float, seed: int) -> None:
    start, rng = random_posture(seed), np.random.default_rng(seed + 100)
    step = rng.normal(size=34)
    turns = step[HUMAN.ball_dofs]
    step[HUMAN.ball_dofs] = turns / np.linalg.norm(turns, axis=-1, keepdims=True)
    np.testing.assert_allclose(start.plus(size * step).minus(start), size * step, atol=2e-9)


def test_turns_are_taken_in_the_childs_frame() -> None:
    start, turn = random_posture(2), np.array([0.1, -0.4, 0.2])
    step = np.zeros(34)
    step[HUMAN.ball_dofs[3]] = turn
    expected = start.rotations[3] @ rotations.exponential(turn)
    np.testing.assert_allclose(start.plus(step).rotations[3], expected, atol=1e-14)


@given(st.integers(0, 2**32 - 1))
def test_vectors_hold_the_whole_posture(seed: int) -> None:
    posture = random_posture(seed, spread=1.5)
    vector = posture.to_vector()
    assert np.linalg.norm(vector[HUMAN.ball_dofs], axis=-1).max() <= np.pi + 1e-12
    assert_same(Posture.from_vector(HUMAN, vector), posture, 1e-7)


@pytest.mark.parametrize("size", [0.0, 1e-8, 0.3, 2.0])
@pytest.mark.parametrize("seed", range(5))
def test_plus_jacobian_agrees_with_central_differences(size: float, seed: int) -> None:
    start, rng = random_posture(seed), np.random.default_rng(seed)
    delta, step = size * rng.normal(0.0, 0.5, 34), 1e-6
    result = start.plus(delta)
    numeric = start.plus(delta + step * np.eye(34)).minus(result) - start.plus(
        delta - step * np.eye(34)
    ).minus(result)
    np.testing.assert_allclose(start.plus_jacobian(delta), numeric.T / (2.0 * step), atol=1e-8)


def test_batches_broadcast_and_index() -> None:
    start, steps = random_posture(4), np.random.default_rng(5).normal(0.0, 0.3, (6, 34))
    many = start.plus(steps)
    assert many.batch == (6,)
    assert_same(many[2], start.plus(steps[2]))
    assert many[1:4].batch == (3,)
    assert_same(Posture.stack([many[i] for i in range(6)]), many, 0.0)
    np.testing.assert_allclose(many.minus(start), steps, atol=1e-12)


def test_a_posture_cannot_be_changed_behind_its_back() -> None:
    given_place = np.zeros(3)
    posture = Posture(HUMAN, given_place, Posture.rest(HUMAN).rotations, Posture.rest(HUMAN).angles)
    given_place[0] = 5.0
    assert posture.translation[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        posture.angles[0] = 1.0
