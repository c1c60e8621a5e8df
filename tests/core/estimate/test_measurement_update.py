"""The measurement update: against closed forms, and with covariances that break careless ones."""

import numpy as np
import pytest
from keymark.core.estimate.kalman import normalized_innovation_squared, update

ILL_CONDITIONED = (
    np.diag([1e8, 1e-10, 1.0]),
    np.array([[1e6, 1e6 - 1e-4, 0.0], [1e6 - 1e-4, 1e6, 0.0], [0.0, 0.0, 1e-9]]),
    1e4 * np.ones((3, 3)) + np.diag([1e-9, 2e-9, 3e-9]),
)
"""Condition numbers of 1e18, 1e15 and 1e13: a plain (I - K H) M leaves them indefinite or lopsided."""


def test_the_gain_agrees_with_the_information_form() -> None:
    """Paper, eqs. 15 and 16, in their other form: P⁻¹ = M⁻¹ + Hᵀ H and K = P Hᵀ."""
    rng = np.random.default_rng(0)
    root, H, innovation = rng.normal(size=(6, 6)), rng.normal(size=(9, 6)), rng.normal(size=9)
    M = root @ root.T + np.eye(6)
    result = update(M, H, innovation)
    information = np.linalg.solve(M, np.eye(6)) + H.T @ H
    np.testing.assert_allclose(result.covariance @ information, np.eye(6), atol=1e-9)
    np.testing.assert_allclose(result.step, np.linalg.solve(information, H.T @ innovation), rtol=1e-9)
    S = H @ M @ H.T + np.eye(9)
    assert result.normalized_innovation_squared == pytest.approx(innovation @ np.linalg.solve(S, innovation))
    assert normalized_innovation_squared(M, H, innovation) == pytest.approx(
        result.normalized_innovation_squared
    )


def test_a_scalar_measurement_by_hand() -> None:
    """Variance 3 seen with variance 1: gain 3/4, variance 3/4, an innovation of 2 scores 4/4."""
    result = update(np.array([[3.0]]), np.array([[1.0]]), np.array([2.0]))
    np.testing.assert_allclose([*result.step, *result.covariance[0]], [1.5, 0.75])
    assert result.normalized_innovation_squared == pytest.approx(1.0)


def test_nothing_seen_changes_nothing() -> None:
    M = np.diag([1.0, 2.0])
    result = update(M, np.zeros((0, 2)), np.zeros(0))
    np.testing.assert_array_equal(result.step, 0.0)
    np.testing.assert_array_equal(result.covariance, M)
    assert result.normalized_innovation_squared == 0.0


@pytest.mark.parametrize("M", ILL_CONDITIONED)
def test_ill_conditioned_covariances_stay_symmetric_and_positive(M: np.ndarray) -> None:
    """Two hundred updates with rows of very unlike size leave no negative variance in any direction."""
    rng = np.random.default_rng(1)
    P = M
    for _ in range(200):
        H = rng.normal(size=(4, 3)) * np.array([[1e4], [1.0], [1e-3], [1e2]])
        before = P
        P = update(P, H, rng.normal(size=4)).covariance + 1e-12 * np.eye(3)
        np.testing.assert_array_equal(P, P.T)
        np.linalg.cholesky(P)
        assert np.trace(P) <= np.trace(before) * (1.0 + 1e-9) + 1e-11


def test_the_order_of_measurements_does_not_matter() -> None:
    """One update with all rows equals one update a row."""
    rng = np.random.default_rng(2)
    M, H, seen = np.diag([1.0, 4.0, 9.0]), rng.normal(size=(5, 3)), rng.normal(size=5)
    together = update(M, H, seen)
    state, P = np.zeros(3), M
    for row in (3, 0, 4, 1, 2):
        one = update(P, H[row : row + 1], seen[row : row + 1] - H[row : row + 1] @ state)
        state, P = state + one.step, one.covariance
    np.testing.assert_allclose(state, together.step, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(P, together.covariance, rtol=1e-9, atol=1e-12)
