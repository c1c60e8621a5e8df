"""The markers' speed, and the keyframes proposed from it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.errors import InputError
from keymark.core.footage.region_tracks import RegionTracks
from keymark.core.prior.marker_speed import marker_speed, propose_keyframes

FPS = 25.0


def tracks_of(centroid: np.ndarray, time_s: np.ndarray | None = None) -> RegionTracks:
    """Tracks with the given centroids (F, M, 2); all else is plain."""
    frames, markers = centroid.shape[:2]
    return RegionTracks(
        names=tuple(f"marker {i}" for i in range(markers)),
        centroid=centroid,
        second_moment=np.broadcast_to(np.eye(2), (frames, markers, 2, 2)),
        area=np.full((frames, markers), 50.0),
        quality=np.ones((frames, markers)),
        clipped=np.zeros((frames, markers), dtype=bool),
        time_s=np.arange(frames) / FPS if time_s is None else time_s,
        size=(320, 240),
    )


def straight(velocities: list[tuple[float, float]], time: np.ndarray) -> np.ndarray:
    """Centroids (F, M, 2) moving evenly by `velocities` [px per unit of time]."""
    return 100.0 + time[:, None, None] * np.array(velocities)


def test_speed_is_the_sum_of_the_lengths_of_the_velocities() -> None:
    """Equation 8 by hand: two markers at 5 and 13 px per frame give 18, not the root of a sum of squares."""
    time = np.arange(12.0)
    speed = marker_speed(tracks_of(straight([(3.0, -4.0), (-5.0, 12.0)], time)))
    np.testing.assert_allclose(speed, 18.0, rtol=1e-12)


def test_uneven_time_stamps_are_respected() -> None:
    """A dropped frame doubles the step, not the speed."""
    time = np.array([0.0, 1.0, 2.0, 4.0, 5.0, 6.0, 7.0])
    tracks = tracks_of(straight([(6.0, 8.0)], time), time / FPS)
    np.testing.assert_allclose(marker_speed(tracks, 0.0), 10.0, rtol=1e-12)


def test_a_stamp_that_does_not_advance_leaves_the_speed_finite() -> None:
    """Files with repeated stamps exist; the frame then counts as one of usual duration."""
    centroid = straight([(3.0, 4.0)], np.arange(6.0))
    speed = marker_speed(tracks_of(centroid, np.array([0.0, 0.04, 0.04, 0.08, 0.12, 0.16])), 0.0)
    np.testing.assert_allclose(speed, 5.0, rtol=1e-12)


def test_a_hidden_stretch_does_not_change_an_even_speed() -> None:
    """Hidden at the start, in the middle and at the end, a marker keeps its speed, so no minimum arises."""
    centroid = straight([(3.0, 4.0), (0.0, 2.0)], np.arange(30.0))
    centroid[:3, 0] = centroid[12:18, 0] = centroid[26:, 0] = np.nan
    np.testing.assert_allclose(marker_speed(tracks_of(centroid)), 7.0, rtol=1e-12)


@pytest.mark.parametrize("seen", [0, 1])
def test_a_marker_seen_less_than_twice_adds_nothing(seen: int) -> None:
    """Its speed is unknown; the others' still counts."""
    centroid = straight([(3.0, 4.0), (9.0, 9.0)], np.arange(10.0))
    centroid[seen:, 1] = np.nan
    np.testing.assert_allclose(marker_speed(tracks_of(centroid)), 5.0, rtol=1e-12)


def test_smoothing_calms_noise_and_keeps_the_mean() -> None:
    """The light smoothing takes jitter of single frames out."""
    rng = np.random.default_rng(4)
    tracks = tracks_of(straight([(5.0, 0.0)], np.arange(200.0)) + rng.normal(0.0, 1.0, (200, 1, 2)))
    rough, smooth = marker_speed(tracks, 0.0), marker_speed(tracks, 2.0)
    assert np.std(smooth) < 0.6 * np.std(rough)
    assert smooth.mean() == pytest.approx(rough.mean(), rel=0.02)


def test_a_single_frame_has_no_speed() -> None:
    """One frame tells nothing of motion, and is no error."""
    np.testing.assert_array_equal(marker_speed(tracks_of(np.ones((1, 2, 2)))), [0.0])


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
    """The density at which the method is meant to work."""
    assert len(propose_keyframes(np.ones(120))) == 12


def test_a_smaller_largest_gap_brings_more_keyframes() -> None:
    """An asked-for gap outranks the default number."""
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
    """The sentence names the value and what would be valid."""
    with pytest.raises(InputError, match=f"{named}.*(valid|or more)"):
        propose_keyframes(np.ones(frames), count, gap)
