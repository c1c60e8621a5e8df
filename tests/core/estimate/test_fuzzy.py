"""The fuzzy rules: input sets, clipped and joined output sets."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.estimate.fuzzy import Memberships, OutputSet, aggregate, keyframe_distance


def output(center: float, width: float, degree: float) -> OutputSet:
    return OutputSet(np.array([center]), np.array([width]), degree)


def test_distance_counts_in_half_gaps() -> None:
    expected = [1, 0.5, 0, 0.5, 1, 0.5, 0, 1 / 3, 2 / 3, 1, 2 / 3, 1 / 3, 0, 1 / 3, 2 / 3]
    np.testing.assert_allclose(keyframe_distance(15, [2, 6, 12]), expected, rtol=1e-12)
    np.testing.assert_allclose(keyframe_distance(9, [6, 8])[[0, 7]], 1.0, rtol=1e-12)


def test_a_single_keyframe_measures_by_the_clip() -> None:
    np.testing.assert_allclose(keyframe_distance(5, [0]), [0.0, 0.4, 0.8, 1.0, 1.0], rtol=1e-12)


def test_input_sets_by_hand() -> None:
    sets = Memberships(near_ends=0.8, far_starts=0.2, far_full=0.6)
    np.testing.assert_allclose(sets.near([0.0, 0.2, 0.8, 1.0]), [1.0, 0.75, 0.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(sets.far([0.0, 0.2, 0.4, 0.6, 1.0]), [0.0, 0.0, 0.5, 1.0, 1.0], atol=1e-15)


def test_one_rule_alone_is_its_own_triangle() -> None:
    mean, variance = aggregate(output(2.0, 0.6, 1.0), output(9.0, 5.0, 0.0))
    assert mean[0] == pytest.approx(2.0, abs=1e-14)
    assert variance[0] == pytest.approx(0.06, rel=1e-12)


def test_two_sets_apart_mix_by_their_areas() -> None:
    mean, variance = aggregate(output(0.0, 1.0, 1.0), output(7.0, 1.0, 0.5))
    assert mean[0] == pytest.approx(3.0, rel=1e-12)
    between = (4.0 / 7.0) * 9.0 + (3.0 / 7.0) * 16.0
    assert variance[0] == pytest.approx((4.0 / 7.0) / 6.0 + (3.0 / 7.0) * 5.0 / 24.0 + between, rel=1e-12)


degrees = st.floats(0.0, 1.0)
widths = st.floats(0.05, 3.0)
centers = st.floats(-5.0, 5.0)


@given(centers, widths, st.floats(0.02, 1.0), centers, widths, degrees)
def test_the_closed_form_agrees_with_fine_sampling(
    first: float, first_width: float, first_degree: float, second: float, second_width: float, degree: float
) -> None:
    """Mean and variance of the maximum, summed over 200 001 values."""
    near, far = output(first, first_width, first_degree), output(second, second_width, degree)
    low = min(first - first_width, second - second_width)
    high = max(first + first_width, second + second_width)
    value = np.linspace(low, high, 200_001)[:, None]
    membership = np.maximum(near.membership(value), far.membership(value))
    sampled = float((membership * value).sum() / membership.sum())
    spread = float((membership * (value - sampled) ** 2).sum() / membership.sum())
    mean, variance = aggregate(near, far)
    assert mean[0] == pytest.approx(sampled, abs=1e-4)
    assert variance[0] == pytest.approx(spread, rel=1e-3, abs=1e-5)
