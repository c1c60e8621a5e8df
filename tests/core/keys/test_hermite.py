"""Cubics between keys: exact where the data are cubic, local where only some keys may change."""

import numpy as np
import pytest
from keymark.core.keys.hermite import Spline, fit_keys, refit

TIMES = np.concatenate([np.arange(20.0), 20.0 + 0.5 * np.arange(20)])
NONE = np.zeros(0, dtype=np.intp)


def wave() -> np.ndarray:
    return np.column_stack([np.sin(TIMES / 4.0), np.cos(TIMES / 7.0) + 0.02 * TIMES])


def test_a_cubic_needs_two_keys() -> None:
    data = np.polynomial.polynomial.polyval(TIMES, [1.0, -0.3, 0.02, -0.0004])[:, None]
    spline = fit_keys(TIMES, data, np.array([0, 39]), NONE)
    assert spline.evaluate(TIMES, 0, 39) == pytest.approx(data, abs=2e-4)
    slope = -0.3 + 0.04 * TIMES[-1] - 0.0012 * TIMES[-1] ** 2
    assert spline.slopes[-1, 0] == pytest.approx(slope, abs=1e-3)


def test_exact_keys_have_the_datas_values_and_others_may_not() -> None:
    data = wave()
    data[20] += 0.3
    keys = np.array([0, 8, 20, 31, 39])
    free, held = (fit_keys(TIMES, data, keys, exact) for exact in (NONE, np.array([20])))
    assert held.values[2] == pytest.approx(data[20], abs=1e-12)
    assert np.abs(free.values[2] - data[20]).min() > 0.1


def test_fitting_some_keys_anew_leaves_the_others() -> None:
    keys = np.array([0, 6, 12, 18, 24, 32, 39])
    start = Spline(keys, wave()[keys], np.zeros((7, 2)))
    fitted = refit(TIMES, wave(), start, 2, 3, NONE)
    others = [0, 1, 4, 5, 6]
    assert np.array_equal(fitted.values[others], start.values[others])
    assert np.array_equal(fitted.slopes[others], start.slopes[others])
    before, after = (np.abs(s.evaluate(TIMES, 6, 24) - wave()[6:25]).max() for s in (start, fitted))
    assert after < 0.5 * before


def test_a_key_on_the_curve_moves_nothing() -> None:
    spline = fit_keys(TIMES, wave(), np.array([0, 12, 39]), NONE)
    further = spline.with_keys(TIMES, np.array([5, 27]))
    assert list(further.keys) == [0, 5, 12, 27, 39]
    assert further.evaluate(TIMES, 0, 39) == pytest.approx(spline.evaluate(TIMES, 0, 39), abs=1e-12)
    back = further.without_key(3).without_key(1)
    assert np.array_equal(back.values, spline.values)
