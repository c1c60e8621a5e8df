"""The markers' summed speed in the image."""

import numpy as np
import pytest
from keymark.core.footage.region_tracks import RegionTracks
from keymark.core.prior.keyframe_proposals import marker_speed

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
    time = np.array([0.0, 1.0, 2.0, 4.0, 5.0, 6.0, 7.0])
    tracks = tracks_of(straight([(6.0, 8.0)], time), time / FPS)
    np.testing.assert_allclose(marker_speed(tracks, 0.0), 10.0, rtol=1e-12)


def test_a_stamp_that_does_not_advance_leaves_the_speed_finite() -> None:
    """Files with repeated stamps exist; the frame then counts as one of usual duration."""
    centroid = straight([(3.0, 4.0)], np.arange(6.0))
    speed = marker_speed(tracks_of(centroid, np.array([0.0, 0.04, 0.04, 0.08, 0.12, 0.16])), 0.0)
    np.testing.assert_allclose(speed, 5.0, rtol=1e-12)


def test_a_hidden_stretch_does_not_change_an_even_speed() -> None:
    centroid = straight([(3.0, 4.0), (0.0, 2.0)], np.arange(30.0))
    centroid[:3, 0] = centroid[12:18, 0] = centroid[26:, 0] = np.nan
    np.testing.assert_allclose(marker_speed(tracks_of(centroid)), 7.0, rtol=1e-12)


@pytest.mark.parametrize("seen", [0, 1])
def test_a_marker_seen_less_than_twice_adds_nothing(seen: int) -> None:
    centroid = straight([(3.0, 4.0), (9.0, 9.0)], np.arange(10.0))
    centroid[seen:, 1] = np.nan
    np.testing.assert_allclose(marker_speed(tracks_of(centroid)), 5.0, rtol=1e-12)


def test_smoothing_calms_noise_and_keeps_the_mean() -> None:
    rng = np.random.default_rng(4)
    tracks = tracks_of(straight([(5.0, 0.0)], np.arange(200.0)) + rng.normal(0.0, 1.0, (200, 1, 2)))
    rough, smooth = marker_speed(tracks, 0.0), marker_speed(tracks, 2.0)
    assert np.std(smooth) < 0.6 * np.std(rough)
    assert smooth.mean() == pytest.approx(rough.mean(), rel=0.02)


def test_a_single_frame_has_no_speed() -> None:
    np.testing.assert_array_equal(marker_speed(tracks_of(np.ones((1, 2, 2)))), [0.0])
