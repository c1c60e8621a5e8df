"""The fuzzy rules: input sets, clipped and joined output sets, and the compact form."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.estimate.fuzzy import Memberships, OutputSet, aggregate, keyframe_distance
from numpy.typing import ArrayLike


def output(center: float, width: float, degree: float) -> OutputSet:
    return OutputSet(np.array([center]), np.array([width]), degree)


def nearness(
    near_degree: ArrayLike, far_degree: ArrayLike, near_width: float, far_width: float
) -> np.ndarray:
    """μ of the compact form δ_t+1 = (1 - μ) δ_t: the rules defuzzified to one number.

    With δ = θ̂ - θ_p the deviation from the a priori posture, the far rule's step is θ_p,t+1 - θ_p,t and
    keeps δ; the near rule's is shorter by δ and ends at δ = 0. Measured from the far step the two output sets
    stand at -δ and at 0. Sets that do not overlap have a joined mean of -δ A_near / (A_near + A_far), where
    A = width · degree · (2 - degree) is the area of a clipped triangle. Hence δ_t+1 = δ_t + mean, which is
    (1 - μ) δ_t with μ = A_near / (A_near + A_far). Sets that overlap share area, which the maximum counts
    once; the joined mean then differs from -μ δ by less than a width, which is within the process noise.
    Where only one rule applies both forms agree exactly: μ is 1 or 0.

    Args:
        near_degree: (...) degree of the near rule.
        far_degree: (...) degree of the far rule.
        near_width: half-width of the near rule's output set, in any unit.
        far_width: half-width of the far rule's output set, in the same unit.

    Returns:
        (...) μ between 0 and 1.
    """
    near, far = np.asarray(near_degree, dtype=np.float64), np.asarray(far_degree, dtype=np.float64)
    near_area = near_width * near * (2.0 - near)
    far_area = far_width * far * (2.0 - far)
    return np.asarray(near_area / (near_area + far_area))


def test_distance_counts_in_half_gaps() -> None:
    expected = [1, 0.5, 0, 0.5, 1, 0.5, 0, 1 / 3, 2 / 3, 1, 2 / 3, 1 / 3, 0, 1 / 3, 2 / 3]
    np.testing.assert_allclose(keyframe_distance(15, [2, 6, 12]), expected, rtol=1e-12)


def test_a_single_keyframe_measures_by_the_clip() -> None:
    np.testing.assert_allclose(keyframe_distance(5, [0]), [0.0, 0.4, 0.8, 1.0, 1.0], rtol=1e-12)


def test_input_sets_by_hand() -> None:
    sets = Memberships(near_ends=0.8, far_starts=0.2, far_full=0.6)
    np.testing.assert_allclose(sets.near([0.0, 0.2, 0.8, 1.0]), [1.0, 0.75, 0.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(sets.far([0.0, 0.2, 0.4, 0.6, 1.0]), [0.0, 0.0, 0.5, 1.0, 1.0], atol=1e-15)


@pytest.mark.parametrize("ends", [(0.3, 0.3, 1.0), (0.5, 0.6, 1.0), (1.0, 0.5, 0.5), (1.0, -0.1, 1.0)])
def test_input_sets_that_leave_a_distance_out_are_refused(ends: tuple[float, float, float]) -> None:
    with pytest.raises(ValueError, match="far_starts"):
        Memberships(*ends)


def test_one_rule_alone_is_its_own_triangle() -> None:
    mean, variance = aggregate(output(2.0, 0.6, 1.0), output(9.0, 5.0, 0.0))
    assert mean[0] == pytest.approx(2.0, abs=1e-14)
    assert variance[0] == pytest.approx(0.06, rel=1e-12)


def test_a_triangle_clipped_at_one_half_is_a_trapezoid() -> None:
    mean, variance = aggregate(output(0.0, 1.0, 0.5), output(0.0, 1.0, 0.0))
    assert mean[0] == pytest.approx(0.0, abs=1e-14)
    assert variance[0] == pytest.approx(5.0 / 24.0, rel=1e-12)


def test_two_sets_apart_mix_by_their_areas() -> None:
    mean, variance = aggregate(output(0.0, 1.0, 1.0), output(7.0, 1.0, 0.5))
    assert mean[0] == pytest.approx(3.0, rel=1e-12)
    between = (4.0 / 7.0) * 9.0 + (3.0 / 7.0) * 16.0
    assert variance[0] == pytest.approx((4.0 / 7.0) / 6.0 + (3.0 / 7.0) * 5.0 / 24.0 + between, rel=1e-12)


def test_joining_counts_what_two_sets_share_once() -> None:
    mean, variance = aggregate(output(1.0, 2.0, 1.0), output(1.0, 2.0, 0.7))
    assert mean[0] == pytest.approx(1.0, abs=1e-14)
    assert variance[0] == pytest.approx(4.0 / 6.0, rel=1e-12)


def test_no_rule_at_all_is_an_error() -> None:
    with pytest.raises(ValueError, match="neither rule"):
        aggregate(output(0.0, 1.0, 0.0), output(0.0, 1.0, 0.0))


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


@given(st.floats(-5.0, 5.0), widths, widths, st.floats(0.02, 1.0), st.floats(0.02, 1.0))
def test_the_compact_form_agrees_with_the_rules(
    deviation: float, near_width: float, far_width: float, near: float, far: float
) -> None:
    """δ' = (1 - μ) δ: exactly while the sets lie apart, to less than a width while they overlap."""
    mean, _ = aggregate(output(-deviation, near_width, near), output(0.0, far_width, far))
    compact = (1.0 - float(nearness(near, far, near_width, far_width))) * deviation
    apart = abs(deviation) >= near_width + far_width
    assert deviation + mean[0] == pytest.approx(compact, abs=1e-9 if apart else max(near_width, far_width))


def test_the_compact_form_by_hand_and_at_its_ends() -> None:
    assert nearness(0.5, 1.0, 1.0, 1.0) == pytest.approx(3.0 / 7.0)
    assert nearness(1.0, 0.0, 0.3, 0.3) == 1.0
    assert nearness(0.0, 1.0, 0.3, 0.3) == 0.0
