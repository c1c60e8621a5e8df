"""How far a person may believe each frame."""

import numpy as np
import pytest
from keymark.core.review.confidence import confidence, expected_covariance, misfits

NONE_COMPARED = np.full((1, 2), np.nan)


@pytest.mark.parametrize("scales", [(1.0, 1.0, 1.0), (0.05, 0.05, 1.0), (0.3, 0.6, 1.0)])
def test_confidence_is_the_share_of_errors_within_the_tolerance(scales: tuple[float, float, float]) -> None:
    rng = np.random.default_rng(3)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    half = turn * (0.03 * np.array(scales))
    errors = rng.normal(size=(40_000, 3)) @ half.T
    share = np.mean(np.linalg.norm(errors, axis=-1) < 0.045)
    believed = confidence((half @ half.T)[None, None], 0.045)
    assert believed == pytest.approx(share, abs=0.015)


def test_confidence_falls_with_each_reason_for_doubt() -> None:
    covariance = np.broadcast_to(0.02**2 * np.eye(3), (1, 13, 3, 3))
    still, moved = np.zeros((1, 13)), np.full((1, 13), 0.2)
    fits, astray, contradicts = (np.array([row]) for row in ([0.1, 0.9, 0.5], [0.1, 90, 0.5], [9, 0.1, 6]))

    def believed(covariance: np.ndarray, moved: np.ndarray, misfit: np.ndarray) -> float:
        return float(confidence(expected_covariance(covariance, moved, misfit), 0.045)[0])

    usual = believed(covariance, still, NONE_COMPARED)
    assert believed(covariance, still, fits) == believed(covariance, still, astray) == usual
    assert believed(4.0 * covariance, still, fits) < usual - 0.1
    assert believed(covariance, moved, fits) < usual - 0.1
    assert believed(covariance, still, contradicts) < usual - 0.1


def test_without_any_evidence_the_covariance_stays_and_what_is_unknown_is_not_a_number() -> None:
    usual, still = np.broadcast_to(0.02**2 * np.eye(3), (1, 13, 3, 3)), np.zeros((1, 13))
    assert np.array_equal(expected_covariance(usual, still, np.zeros((1, 0))), usual)
    covariance = np.zeros((2, 13, 3, 3))
    covariance[1] = np.nan
    believed = confidence(covariance, 0.045)
    assert believed[0] == pytest.approx(1.0) and np.isnan(believed[1])


def test_distances_as_large_as_expected_have_a_misfit_of_one() -> None:
    offset = 0.7 * np.random.default_rng(1).normal(size=(50_000, 1, 2))
    misfit = misfits(np.linalg.norm(offset, axis=-1), np.full((50_000, 1), 0.7))
    assert misfit.mean() == pytest.approx(1.0, abs=0.02)
