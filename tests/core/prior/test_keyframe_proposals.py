"""Frames proposed as keyframes, by the speed of whatever shows the performer."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.arrays import Array
from keymark.core.detect.keypoints import Keypoints
from keymark.core.errors import InputError
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframe_proposals import (
    EvidenceSpeed,
    evidence_speed,
    marker_speed,
    propose_keyframes,
)
from keymark.core.progress import run
from keymark.core.video.album import Album


def test_keyframes_move_to_the_minima_nearby() -> None:
    frames = np.arange(101)
    places = np.array([22, 47, 78])
    speed = np.min(np.abs(frames[:, None] - places), axis=1).astype(float) + 1.0
    np.testing.assert_array_equal(propose_keyframes(speed, count=5), [0, 22, 47, 78, 100])


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
        time_s=np.arange(frames) / 25.0 if time_s is None else time_s,
        size=(320, 240),
    )


def straight(velocities: list[tuple[float, float]], time: np.ndarray) -> np.ndarray:
    """Centroids (F, M, 2) moving evenly by `velocities` [px per unit of time]."""
    return 100.0 + time[:, None, None] * np.array(velocities)


def test_speed_is_the_sum_of_the_lengths_of_the_velocities() -> None:
    time = np.arange(12.0)
    speed = marker_speed(tracks_of(straight([(3.0, -4.0), (-5.0, 12.0)], time)))
    np.testing.assert_allclose(speed, 18.0, rtol=1e-12)


def test_uneven_time_stamps_are_respected() -> None:
    time = np.array([0.0, 1.0, 2.0, 4.0, 5.0, 6.0, 7.0])
    tracks = tracks_of(straight([(6.0, 8.0)], time), time / 25.0)
    np.testing.assert_allclose(marker_speed(tracks), 10.0, rtol=1e-12)


def test_a_stamp_that_does_not_advance_leaves_the_speed_finite() -> None:
    centroid = straight([(3.0, 4.0)], np.arange(6.0))
    speed = marker_speed(tracks_of(centroid, np.array([0.0, 0.04, 0.04, 0.08, 0.12, 0.16])))
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


FRAMES = 90
TIME = np.arange(FRAMES) / 30.0
NAMES = ("wrist.L", "elbow.L", "ankle.R", "knee.R", "shoulder.L", "head")
UNMARKED = RegionTracks.unmarked(TIME, (320, 240))


def swinging(names: tuple[str, ...] = NAMES) -> Array:
    """Paths (F, N, 2) that swing with the same speed, zero every fifteen frames."""
    path = 40.0 * np.cos(np.pi * np.arange(FRAMES) / 15.0)
    return np.stack([np.stack([100.0 + path, 20.0 * i + 0.0 * path], axis=-1) for i in range(len(names))], 1)


def seen(pixel: Array, names: tuple[str, ...] = NAMES, score: float = 1.0) -> Keypoints:
    """Keypoints at those places, all equally sure."""
    shape = pixel.shape[:2]
    return Keypoints(
        names, ("test",) * len(names), pixel, np.full(shape, score), np.full((*shape, 3), np.nan)
    )


def speed_of(
    tracks: RegionTracks = UNMARKED,
    segments: tuple[str, ...] = (),
    keypoints: Keypoints | None = None,
    album: Album | None = None,
) -> EvidenceSpeed:
    return run(evidence_speed(tracks, segments, keypoints or Keypoints.none(FRAMES), album))


def test_markers_alone_give_the_papers_sum() -> None:
    rng = np.random.default_rng(2)
    tracks = tracks_of(swinging() + rng.normal(0.0, 1.0, (FRAMES, len(NAMES), 2)), TIME)
    found = speed_of(tracks, ("forearm.L",) * len(NAMES))
    np.testing.assert_array_equal(found.values, marker_speed(tracks))
    assert found.note == ""


def test_a_part_of_the_body_counts_once_however_many_points_show_it() -> None:
    one = speed_of(keypoints=seen(swinging(NAMES[:1]), NAMES[:1])).values
    np.testing.assert_allclose(speed_of(keypoints=seen(swinging())).values, 3.0 * one, rtol=1e-9)


def test_a_marker_and_keypoints_of_a_limb_count_as_one() -> None:
    names = NAMES[:2]
    arm = seen(swinging(names), names)
    both = speed_of(tracks_of(swinging(names[:1]), TIME), ("forearm.L",), arm).values
    alone = speed_of(keypoints=arm).values
    np.testing.assert_allclose(both, alone, atol=0.3)  # the marker's path is not smoothed


def test_jitter_and_outliers_leave_the_minima_where_they_are() -> None:
    rng = np.random.default_rng(7)
    pixel = swinging() + rng.normal(0.0, 2.0, (FRAMES, len(NAMES), 2))
    wrong = rng.random(pixel.shape[:2]) < 0.1
    pixel[wrong] = rng.uniform(0.0, 300.0, (wrong.sum(), 2))
    speed = speed_of(keypoints=seen(pixel)).values
    for rest in (15, 30, 45, 60, 75):
        near = np.arange(rest - 6, rest + 7)
        assert abs(near[speed[near].argmin()] - rest) <= 2


def test_two_sources_of_a_point_are_averaged_by_how_sure_they_are() -> None:
    once, still = swinging(NAMES[:1]), np.full((FRAMES, 1, 2), 50.0)
    names = NAMES[:1]
    alone = speed_of(keypoints=seen(once, names)).values
    for score, share in ((1.0, 0.5), (1e-6, 1.0)):
        both = Keypoints.side_by_side([seen(once, names), seen(still, names, score)], FRAMES)
        np.testing.assert_allclose(speed_of(keypoints=both).values, share * alone, rtol=1e-4, atol=1e-9)


def test_without_either_the_pictures_tell_where_the_performer_rests() -> None:
    rng = np.random.default_rng(1)
    wall = rng.integers(60, 90, (240, 320, 3))
    album = Album()
    middle = 160.0 + 60.0 * np.cos(np.pi * np.arange(FRAMES) / 15.0)
    for index, x in enumerate(middle):
        picture = np.clip(wall + rng.normal(0.0, 2.0, wall.shape), 0, 255).astype(np.uint8)
        picture[60:200, round(x) - 15 : round(x) + 15] = (200, 210, 190)
        album.add(index, picture)
    found = speed_of(album=album)
    assert "pictures" in found.note
    for rest in (15, 30, 45, 60, 75):
        near = np.arange(rest - 6, rest + 7)
        assert abs(near[found.values[near].argmin()] - rest) <= 2
    # The bar crosses the middle at 4 pi pixels a frame; the measure is rough.
    assert found.values[22] == pytest.approx(60.0 * np.pi / 15.0, rel=0.35)


def test_with_nothing_at_all_the_speed_is_even_and_that_is_said() -> None:
    found = speed_of()
    np.testing.assert_array_equal(found.values, np.zeros(FRAMES))
    assert "evenly" in found.note
