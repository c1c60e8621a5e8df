"""Cubics between keys: exact where the data are cubic, local where only some keys may change."""

import numpy as np
import pytest
from keymark.core.keys.hermite import Spline, fit_keys, refit, without_each

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


def test_keys_left_out_together_leave_what_each_leaves_alone() -> None:
    keys, exact = np.array([0, 3, 6, 10, 13, 14, 18, 22, 25, 29, 33, 39]), np.array([10])
    spline = fit_keys(TIMES, wave(), keys, exact)
    inner = np.array([3, 4, 6, 8])
    frames, starts, shown = without_each(TIMES, wave(), spline, inner, exact, 2)
    pieces = zip(inner, np.split(frames, starts[1:]), np.split(shown, starts[1:]), strict=True)
    for at, own, values in pieces:
        assert [own[0], own[-1]] == [keys[at - 3], keys[at + 3]]
        alone = refit(TIMES, wave(), spline.without_key(at), at - 2, at + 1, exact)
        assert values == pytest.approx(alone.evaluate(TIMES, own[0], own[-1]), abs=1e-12)
