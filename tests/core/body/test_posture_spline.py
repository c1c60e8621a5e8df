"""Splines through postures, held against SciPy's on degrees of freedom that do not turn."""

import numpy as np
import pytest
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.body.posture_spline import cubic_spline, linear_spline
from scipy.interpolate import CubicHermiteSpline

KNOTS = np.array([0.0, 2.0, 3.0, 7.0, 8.0])
VALUES = np.array([0.1, 0.5, 1.4, 1.6, 0.2])
KNEE = HUMAN.dof_names.index("knee.L.flexion")
TIMES = np.linspace(-1.0, 9.0, 101)


def posed() -> Posture:
    vector = np.zeros((len(KNOTS), 34))
    vector[:, KNEE] = VALUES
    return Posture.from_vector(HUMAN, vector)


def test_a_hinge_follows_the_limited_cubic() -> None:
    slope, gap = np.diff(VALUES) / np.diff(KNOTS), np.diff(KNOTS)
    inner = (gap[1:] * slope[:-1] + gap[:-1] * slope[1:]) / (gap[1:] + gap[:-1])
    limit = 3.0 * np.minimum(abs(slope[:-1]), abs(slope[1:]))
    inner = np.where(slope[:-1] * slope[1:] > 0.0, np.clip(inner, -limit, limit), 0.0)
    assert inner[1] == pytest.approx(3.0 * slope[2]) and inner[2] == 0.0  # both limits are at work
    expected = CubicHermiteSpline(KNOTS, VALUES, np.concatenate([slope[:1], inner, slope[-1:]]))
    found = cubic_spline(posed(), KNOTS, TIMES).to_vector()
    np.testing.assert_allclose(found[:, KNEE], expected(np.clip(TIMES, 0.0, 8.0)), atol=1e-12)
    assert not np.delete(found, KNEE, axis=1).any()


def test_the_linear_spline_is_held_beyond_its_ends() -> None:
    found = linear_spline(posed(), KNOTS, TIMES).to_vector()[:, KNEE]
    np.testing.assert_allclose(found, np.interp(TIMES, KNOTS, VALUES), atol=1e-12)


def test_balls_pass_their_postures_smoothly() -> None:
    turned = Posture.rest(HUMAN, (5,)).plus(np.random.default_rng(2).normal(0.0, 0.5, (5, 34)))
    at = cubic_spline(turned, KNOTS, KNOTS)
    np.testing.assert_allclose(at.minus(turned), 0.0, atol=1e-9)
    step = 1e-5
    before, here, after = (cubic_spline(turned, KNOTS, KNOTS[1:-1] + s) for s in (-step, 0.0, step))
    np.testing.assert_allclose(here.minus(before) / step, after.minus(here) / step, atol=1e-3)
