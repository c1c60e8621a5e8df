"""V_sum of markers, keypoints, or nothing but pictures."""

import numpy as np
import pytest
from keymark.core.arrays import Array
from keymark.core.footage.clips.album import Album
from keymark.core.footage.keypoints.keypoints import Keypoints
from keymark.core.footage.region_tracks import RegionTracks
from keymark.core.prior.keyframe_proposals import EvidenceSpeed, evidence_speed, marker_speed
from keymark.core.progress import run

FRAMES, FPS = 90, 30.0
TIME = np.arange(FRAMES) / FPS
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


def marked(centroid: Array) -> RegionTracks:
    """Tracks with the given centroids (F, M, 2)."""
    shape = centroid.shape[:2]
    return RegionTracks(
        tuple(f"marker {i}" for i in range(shape[1])),
        centroid,
        np.broadcast_to(np.eye(2), (*shape, 2, 2)),
        np.full(shape, 50.0),
        np.ones(shape),
        np.zeros(shape, dtype=bool),
        TIME,
        (320, 240),
    )


def speed_of(
    tracks: RegionTracks = UNMARKED,
    segments: tuple[str, ...] = (),
    keypoints: Keypoints | None = None,
    album: Album | None = None,
) -> EvidenceSpeed:
    return run(evidence_speed(tracks, segments, keypoints or Keypoints.none(FRAMES), album))


def test_markers_alone_give_the_papers_sum() -> None:
    """To the last digit: nothing else is mixed in where there are no keypoints."""
    rng = np.random.default_rng(2)
    tracks = marked(swinging() + rng.normal(0.0, 1.0, (FRAMES, len(NAMES), 2)))
    found = speed_of(tracks, ("forearm.L",) * len(NAMES))
    np.testing.assert_array_equal(found.values, marker_speed(tracks))
    assert found.note == ""


def test_a_part_of_the_body_counts_once_however_many_points_show_it() -> None:
    one = speed_of(keypoints=seen(swinging(NAMES[:1]), NAMES[:1])).values
    np.testing.assert_allclose(speed_of(keypoints=seen(swinging())).values, 3.0 * one, rtol=1e-9)


def test_a_marker_and_keypoints_of_a_limb_count_as_one() -> None:
    names = NAMES[:2]
    arm = seen(swinging(names), names)
    both = speed_of(marked(swinging(names[:1])), ("forearm.L",), arm).values
    alone = speed_of(keypoints=arm).values
    np.testing.assert_allclose(both, alone, atol=0.3)  # the marker's path is not smoothed


def test_jitter_and_outliers_leave_the_minima_where_they_are() -> None:
    """A detector's jitter of two pixels, and every tenth point anywhere, still show where the swing rests."""
    rng = np.random.default_rng(7)
    pixel = swinging() + rng.normal(0.0, 2.0, (FRAMES, len(NAMES), 2))
    wrong = rng.random(pixel.shape[:2]) < 0.1
    pixel[wrong] = rng.uniform(0.0, 300.0, (wrong.sum(), 2))
    speed = speed_of(keypoints=seen(pixel)).values
    for rest in (15, 30, 45, 60, 75):
        near = np.arange(rest - 6, rest + 7)
        assert abs(near[speed[near].argmin()] - rest) <= 2


def test_two_sources_of_a_point_are_averaged_by_how_sure_they_are() -> None:
    """A second detector that sees nothing move halves the speed, and does nothing where it is not sure."""
    once, still = swinging(NAMES[:1]), np.full((FRAMES, 1, 2), 50.0)
    names = NAMES[:1]
    alone = speed_of(keypoints=seen(once, names)).values
    for score, share in ((1.0, 0.5), (1e-6, 1.0)):
        both = Keypoints.side_by_side([seen(once, names), seen(still, names, score)], FRAMES)
        np.testing.assert_allclose(speed_of(keypoints=both).values, share * alone, rtol=1e-4, atol=1e-9)


def test_without_either_the_pictures_tell_where_the_performer_rests() -> None:
    """A bar that swings before a textured wall; noise of the camera is no motion."""
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


def test_unseen_keypoints_are_none() -> None:
    tracks = marked(swinging())
    nobody = seen(np.full((FRAMES, len(NAMES), 2), np.nan), score=0.0)
    segments = ("forearm.L",) * len(NAMES)
    np.testing.assert_array_equal(speed_of(tracks, segments, nobody).values, marker_speed(tracks))
