"""Keyframes proposed from the markers' summed speed."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.errors import InputError
from keymark.core.prior.keyframe_proposals import propose_keyframes


def test_keyframes_move_to_the_minima_nearby() -> None:
    """With a minimum close to each even place, the minima are taken and the ends kept."""
    frames = np.arange(101)
    places = np.array([22, 47, 78])
    speed = np.min(np.abs(frames[:, None] - places), axis=1).astype(float) + 1.0
    np.testing.assert_array_equal(propose_keyframes(speed, count=5), [0, 22, 47, 78, 100])


def test_keyframes_stay_even_where_no_minimum_is_near() -> None:
    """A steadily rising speed has no inner minimum; spacing decides alone."""
    np.testing.assert_array_equal(propose_keyframes(np.arange(101.0), count=5), [0, 25, 50, 75, 100])


def test_ten_keyframes_per_hundred_frames_are_the_default() -> None:
    assert len(propose_keyframes(np.ones(120))) == 12


def test_a_smaller_largest_gap_brings_more_keyframes() -> None:
    chosen = propose_keyframes(np.ones(101), largest_gap=5)
    assert len(chosen) == 21
    assert np.diff(chosen).max() <= 5


@given(
    speed=st.lists(st.floats(0.0, 100.0) | st.just(float("nan")), min_size=2, max_size=150),
    count=st.none() | st.integers(2, 60),
    largest_gap=st.none() | st.integers(1, 60),
)
def test_proposed_keyframes_always_keep_their_promises(
    speed: list[float], count: int | None, largest_gap: int | None
) -> None:
    """Both ends are in, frames increase, no gap is too large, the number is kept where the gap allows it."""
    count = None if count is None else min(count, len(speed))
    chosen = propose_keyframes(speed, count, largest_gap)
    assert chosen[0] == 0
    assert chosen[-1] == len(speed) - 1
    gaps = np.diff(chosen)
    assert gaps.min() >= 1
    if largest_gap is not None:
        assert gaps.max() <= largest_gap
    elif count is not None:
        assert len(chosen) == count
        assert gaps.max() <= np.ceil(1.5 * (len(speed) - 1) / (count - 1))


@pytest.mark.parametrize(
    ("frames", "count", "gap", "named"),
    [(1, None, None, "1 frame"), (9, 1, None, "1"), (9, 10, None, "10"), (9, 3, 0, "0")],
)
def test_impossible_wishes_are_refused_with_their_value(
    frames: int, count: int | None, gap: int | None, named: str
) -> None:
    with pytest.raises(InputError, match=f"{named}.*(valid|or more)"):
        propose_keyframes(np.ones(frames), count, gap)
