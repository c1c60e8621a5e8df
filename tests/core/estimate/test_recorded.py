"""Estimates of seeded performances by every kind of evidence, number by number."""

from dataclasses import replace

import numpy as np
import pytest
from _recorded import assert_recorded
from _scene import (
    BODY,
    CAMERA,
    MODEL,
    SEGMENTS,
    album,
    belief_in,
    detect,
    exercise,
    film,
    lasting,
    no_points,
    sides_exchanged,
)
from _scene import FRAMES as FILMED_FRAMES
from _scene import POSED as FILMED_POSED
from _scene import TRUTH as FILMED
from keymark.core.body.posture import Posture
from keymark.core.estimate.belief import posing_covariance
from keymark.core.estimate.clip_problem import Seen, uncalibrated
from keymark.core.estimate.performer_placement import found_ankle_m, place_standing
from keymark.core.estimate.reference_alignment import about_hips, align
from keymark.core.estimate.reference_evidence import STD_M, error_factor, own_and_usual_cost
from keymark.core.estimate.reference_placement import SeenPoints
from keymark.core.estimate.single_frame import fit_frame, frame_residuals
from keymark.core.estimate.whole_clip import WholeClipResult, estimate_whole_clip
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.frame_prior import prior_from_keyframes
from keymark.core.prior.keyframes import Keyframe, interpolate
from keymark.core.progress import run
from keymark.core.take.reference import ReferenceMotion
from keymark.core.terms.regions import ObservedRegions

FRAMES, POSED = 46, (0, 11, 22, 33, 45)
TRUTH = exercise(FRAMES)


def by_hand(seed: int) -> Posture:
    """The true keyframes with a person's posing error, interpolated."""
    rng = np.random.default_rng(seed)
    exact = TRUTH[np.array(POSED)]
    factor = np.linalg.cholesky(posing_covariance(BODY, BODY.pose(exact)))
    posed = exact.plus((factor @ rng.normal(size=(*factor.shape[:-1], 1)))[..., 0])
    return interpolate(tuple(Keyframe(index, posed[row]) for row, index in enumerate(POSED)), FRAMES)


def hold(name: str, result: WholeClipResult, share: float = 1e-4) -> None:
    """Hold postures and covariances to what was recorded."""
    assert_recorded(name, BODY.points(BODY.pose(result.posture)), share=share)
    assert_recorded(
        f"{name}, covariance", result.covariance, [result.evidence.posing_scale], share=10 * share
    )


def test_by_markers() -> None:
    tracks = film(TRUTH, 0.5, seed=3)
    centroid = tracks.centroid.copy()
    centroid[14, 1] += 40.0
    seen = Seen(replace(tracks, centroid=centroid), SEGMENTS)
    hold("estimate by markers", run(estimate_whole_clip(BODY, CAMERA, seen, belief_in(by_hand(1), POSED))))


@pytest.mark.parametrize("found", [False, True])
def test_by_keypoints(found: bool) -> None:
    bare = RegionTracks.unmarked(np.arange(FRAMES) / 30.0, CAMERA.resolution)
    scale = np.full(len(POSED), 1.5) if found else None
    seen = Seen(bare, (), detect(TRUTH))
    prior, index = by_hand(2), np.array(POSED)
    ankle_m = found_ankle_m(BODY, prior[index], index, FRAMES) if found else None
    result = run(estimate_whole_clip(BODY, CAMERA, seen, belief_in(prior, POSED, scale, None, ankle_m)))
    hold(f"estimate by keypoints, found {found}", result)


def test_by_contours() -> None:
    keyframes = tuple(Keyframe(int(index), FILMED[index : index + 1][0]) for index in FILMED_POSED)
    bare = RegionTracks.unmarked(np.arange(FILMED_FRAMES) / 30.0, CAMERA.resolution)
    believed = belief_in(interpolate(keyframes, FILMED_FRAMES), tuple(int(index) for index in FILMED_POSED))
    seen = Seen(bare, (), album=album())
    result = run(estimate_whole_clip(BODY, CAMERA, seen, believed))
    hold("estimate by contours", result, 2e-3)  # OpenCV's releases draw a border's pixels differently


def test_single_frames() -> None:
    tracks = film(TRUTH, 1.0, seed=2)
    observed = ObservedRegions.from_tracks(tracks)
    for frame in (15, 27, 40):
        belief = prior_from_keyframes([Keyframe(frame - 12, TRUTH[frame - 12])], frame, 30.0)
        own = observed[np.array([frame])]
        before = frame_residuals(uncalibrated(MODEL), own, no_points(), belief.posture, frame)
        fit = fit_frame(uncalibrated(MODEL), own, belief, frame, no_points())
        assert_recorded(f"frame {frame}", before.marker_px, fit.posture.to_vector(), share=1e-4)
    standing = place_standing(BODY, CAMERA, 20, tracks, SEGMENTS)
    assert_recorded("standing", standing.to_vector(), share=1e-4)


def test_a_reference_motion() -> None:
    frames = 60
    truth = exercise(2 * frames)[::2]
    points = BODY.points(BODY.pose(truth))
    rng = np.random.default_rng(4)
    error = 0.6 * lasting(rng, points.shape) + 0.3 * rng.normal(size=points.shape)
    guess = about_hips(points + error * STD_M[:, None] * [1.0, 2.2, 1.0])
    tracks = RegionTracks.unmarked(np.arange(frames) / 30.0, CAMERA.resolution)
    seen = SeenPoints.of(CAMERA, detect(truth, error_m=0.02), tracks, ())
    found = align(ReferenceMotion(1.1 * guess[:, :, [1, 2, 0]], None), BODY, seen, tracks.time_s, 30.0)
    assert_recorded("aligned", found.points, found.hips, [found.lag], share=1e-4)
    assert_recorded(
        "aligned, worth",
        own_and_usual_cost(found, seen),
        error_factor(found, seen, tracks.time_s),
        share=1e-4,
    )


def test_by_a_detector_that_exchanges_sides() -> None:
    sides = np.zeros(FRAMES, dtype=bool)
    sides[18:27] = True
    bare = RegionTracks.unmarked(np.arange(FRAMES) / 30.0, CAMERA.resolution)
    seen = Seen(bare, (), sides_exchanged(detect(TRUTH), sides))
    hold(
        "estimate by wrong sides", run(estimate_whole_clip(BODY, CAMERA, seen, belief_in(by_hand(3), POSED)))
    )
