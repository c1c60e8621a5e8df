"""Measures of whether an estimate is as good as it says."""

import numpy as np
import pytest
from _consistency import chi_square_average, coverage, mean_interval, normalized_squared


def test_normalized_squares_by_hand() -> None:
    """Two standard deviations along one axis and one along the other: 4 + 1; correlation is taken out."""
    assert normalized_squared([4.0, 3.0], np.diag([4.0, 9.0])) == pytest.approx(5.0)
    assert normalized_squared([1.0, 1.0], [[2.0, 1.0], [1.0, 2.0]]) == pytest.approx(2.0 / 3.0)


def test_normalized_squares_of_a_batch() -> None:
    errors = np.arange(12.0).reshape(2, 3, 2)
    batch = normalized_squared(errors, np.broadcast_to(np.diag([1.0, 4.0]), (2, 3, 2, 2)))
    np.testing.assert_allclose(batch, errors[..., 0] ** 2 + errors[..., 1] ** 2 / 4.0)


def test_a_covariance_that_is_none_is_an_error() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        normalized_squared([1.0, 1.0], [[1.0, 2.0], [2.0, 1.0]])


def test_chi_square_bounds_are_the_tables() -> None:
    """10 degrees of freedom in one sample: 3.247 and 20.483 enclose 95 %."""
    interval = chi_square_average([10.0], 10)
    assert interval.average == 10.0
    assert interval.low == pytest.approx(3.247, abs=5e-4)
    assert interval.high == pytest.approx(20.483, abs=5e-4)


def test_the_average_tells_honest_from_overconfident_and_timid() -> None:
    """Errors drawn with their covariance lie within; with covariances half and twice as large they do not."""
    errors = np.random.default_rng(3).normal(size=(50, 6))
    for scale, verdict in ((1.0, "honest"), (0.5, "overconfident"), (2.0, "timid")):
        values = normalized_squared(errors, np.eye(6) * scale)
        average, low, high = chi_square_average(values, 6)
        found = "overconfident" if average > high else "timid" if average < low else "honest"
        assert found == verdict


def test_degrees_of_freedom_may_differ_between_frames() -> None:
    """Hidden markers bring fewer rows: 2 + 4 + 6 degrees in three frames are 4 on the average."""
    interval = chi_square_average([2.0, 4.0, 6.0], [2, 4, 6])
    assert interval.low < 4.0 < interval.high
    assert interval == chi_square_average([4.0, 4.0, 4.0], 4)


def test_coverage_by_hand() -> None:
    """Three of four within 1.96; what has no error or no sigma is left out."""
    error, sigma = [1.0, -1.9, 2.0, 1.0, 9.0, np.nan], [1.0, 1.0, 1.0, 1.0, np.nan, 1.0]
    assert coverage(error, sigma) == 0.75
    assert np.isnan(coverage([np.nan], [1.0]))


def test_the_interval_of_a_mean_is_students() -> None:
    """1, 2, 3: mean 2, standard error 1/√3, t of 2 degrees of freedom 4.303."""
    interval = mean_interval([1.0, 2.0, 3.0])
    assert interval.average == pytest.approx(2.0)
    assert interval.high - 2.0 == pytest.approx(4.303 / np.sqrt(3.0), abs=1e-3)
    assert 2.0 - interval.low == pytest.approx(interval.high - 2.0)
    with pytest.raises(ValueError, match="2 runs"):
        mean_interval([1.0])
