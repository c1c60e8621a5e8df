"""One frame's posture from its marker regions: nearer to the truth than what was believed."""

from dataclasses import replace

import numpy as np
import pytest
from _scene import BODY, CAMERA, MODEL, exercise, film, no_points, point_error_m
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.posture import Posture
from keymark.core.detect.keypoints import Keypoints, mirrored_point
from keymark.core.estimate.clip_problem import KeyframeEvidence, uncalibrated
from keymark.core.estimate.keypoint_evidence import KeypointEvidence
from keymark.core.estimate.performer_placement import place_standing
from keymark.core.estimate.single_frame import FrameFit, fit_frame, frame_residuals
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.frame_prior import FramePrior, prior_from_keyframes, prior_from_pose
from keymark.core.prior.keyframes import Keyframe
from keymark.core.terms.keypoints import KeypointModel, ObservedKeypoints
from keymark.core.terms.region_model import RegionModel
from keymark.core.terms.regions import ObservedRegions

TRUTH = exercise(45)


def fit(belief: FramePrior, tracks: RegionTracks, frame: int) -> FrameFit:
    observed = ObservedRegions.from_tracks(tracks)
    return fit_frame(uncalibrated(MODEL), observed[np.array([frame])], belief, frame, no_points())


def before_px(belief: FramePrior, tracks: RegionTracks, frame: int) -> np.ndarray:
    """(M,) distances of the markers from where they are believed."""
    observed = ObservedRegions.from_tracks(tracks)[np.array([frame])]
    return frame_residuals(uncalibrated(MODEL), observed, no_points(), belief.posture, frame).marker_px


def keyframes(*frames: int) -> tuple[Keyframe, ...]:
    return tuple(Keyframe(frame, TRUTH[frame]) for frame in frames)


def error_mm(posture: Posture, frame: int) -> float:
    """Mean distance of the 13 points from the truth."""
    return 1000.0 * float(point_error_m(Posture.stack([posture]), TRUTH[frame : frame + 1]).mean())


def test_the_fit_leads_from_the_keyframe_before_towards_the_truth() -> None:
    tracks = film(TRUTH, noise_px=0.3, seed=1)
    before, after = [], []
    for frame in range(10, 45, 5):
        belief = prior_from_keyframes(keyframes(frame - 10), frame, 30.0)
        found = fit(belief, tracks, frame)
        before.append(error_mm(belief.posture, frame))
        after.append(error_mm(found.posture, frame))
    assert np.mean(after) < 0.45 * np.mean(before)


@pytest.mark.parametrize("seed", range(6))
def test_the_markers_are_never_seen_farther_off_than_before(seed: int) -> None:
    rng = np.random.default_rng(seed)
    tracks = film(TRUTH, noise_px=12.0, seed=seed)
    centroid = np.array(tracks.centroid)
    centroid[:, 1] = centroid[:, 2]
    centroid[:, rng.integers(5)] = np.nan
    tracks = replace(tracks, centroid=centroid)
    frame = int(rng.integers(10, 45))
    belief = prior_from_keyframes(keyframes(frame - 10), frame, 30.0)
    found = fit(belief, tracks, frame)
    assert np.nansum(np.log1p(found.off.marker_px**2)) <= np.nansum(
        np.log1p(before_px(belief, tracks, frame) ** 2)
    )
    hidden = ~np.isfinite(tracks.centroid[frame, :, 0])
    np.testing.assert_array_equal(np.isnan(found.off.marker_px), hidden)


def test_what_is_believed_exactly_stays() -> None:
    tracks = film(TRUTH)
    tracks = replace(tracks, centroid=np.full_like(tracks.centroid, np.nan))
    found = fit(prior_from_keyframes(keyframes(5), 20, 30.0), tracks, 20)
    assert np.abs(found.posture.minus(TRUTH[5])).max() < 1e-9
    assert found.off.markers == ()


def test_a_marker_that_no_posture_explains_is_named() -> None:
    tracks = film(TRUTH)
    centroid = np.array(tracks.centroid)
    centroid[20, 3] = (4.0, 4.0)
    found = fit(prior_from_keyframes(keyframes(15), 20, 30.0), replace(tracks, centroid=centroid), 20)
    assert found.off.markers == (3,)
    assert np.nanmax(np.delete(found.off.marker_px, 3)) < 3.0


def test_the_ground_tells_how_far_away_someone_stands() -> None:
    camera = replace(
        CAMERA,
        matrix_world=np.array([[1.0, 0, 0, 0], [0, 0.5, -0.866, -3.6], [0, 0.866, 0.5, 2.9], [0, 0, 0, 1]]),
    )
    model = replace(MODEL, camera=camera)
    believed = standing_posture(BODY)
    errors = []
    for place in (-0.4, 0.3, 0.5):
        true = Posture.stack([standing_posture(BODY, np.array([0.0, place, 0.0]))])
        observed = ObservedRegions.from_tracks(film(true, noise_px=0.3, seed=6, model=model))
        belief = prior_from_keyframes((Keyframe(0, believed),), 60, 30.0)
        fits = [
            fit_frame(uncalibrated(model), observed, known, 0, no_points())
            for known in (belief, replace(belief, grounded=None))
        ]
        errors.append([float(np.linalg.norm(f.posture.translation - true.translation[0])) for f in fits])
    grounded, floating = np.mean(errors, axis=0)
    assert grounded < 0.8 * floating


def test_hinges_keep_their_range() -> None:
    tracks = film(TRUTH, noise_px=2.0, seed=5)
    limits = BODY.skeleton.limits[BODY.skeleton.hinge_dofs]
    for frame in range(5, 45, 8):
        angles = fit(prior_from_keyframes(keyframes(frame - 5), frame, 30.0), tracks, frame).posture.angles
        assert np.all(angles > limits[:, 0] - 0.1)
        assert np.all(angles < limits[:, 1] + 0.1)


def test_a_rough_pose_is_corrected() -> None:
    rng = np.random.default_rng(4)
    tracks = film(TRUTH, noise_px=0.3, seed=4)
    rough = np.where(np.arange(34) < 6, 0.02, 0.15) * rng.normal(size=34)
    belief = prior_from_pose(TRUTH[20].plus(rough))
    found = fit(belief, tracks, 20)
    assert error_mm(found.posture, 20) < 0.8 * error_mm(belief.posture, 20)
    assert np.nanmean(found.off.marker_px) < 0.3 * np.nanmean(before_px(belief, tracks, 20))


NAMES = (
    "nose", "ear.L", "ear.R",
    *(f"{joint}.{side}" for joint in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle") for side in "LR"),
)  # fmt: skip
UNMARKED = RegionModel(BODY, CAMERA, ())


def detected(noise_px: float, hint_std_m: float | None = None, seed: int = 3) -> Keypoints:
    """What a detector finds of the exercise, with the depths that a network guesses."""
    rng = np.random.default_rng(seed)
    frames = np.arange(len(TRUTH.translation))
    model, pose = KeypointModel.usual(BODY, CAMERA, NAMES), BODY.pose(TRUTH)
    pixel = model.pixels(pose, frames)
    pixel = pixel + rng.normal(0.0, noise_px, pixel.shape)
    hint = np.full((*pixel.shape[:2], 3), np.nan)
    if hint_std_m is not None:
        depth = CAMERA.depth(model.world(pose), frames[:, None])
        hint[:] = 0.0
        hint[..., 2] = depth - depth[:, 9:11].mean(axis=1, keepdims=True)
        hint[..., 2] += rng.normal(0.0, hint_std_m, depth.shape)
    return Keypoints(NAMES, ("test",) * len(NAMES), pixel, np.full(pixel.shape[:2], 0.9), hint)


def unmarked_evidence() -> KeyframeEvidence:
    """Evidence of keypoints alone, before any keyframe is posed."""
    usual = KeypointEvidence.usual(BODY, CAMERA, NAMES, ("test",) * len(NAMES))
    return uncalibrated(UNMARKED, usual)


def fit_points(belief: FramePrior, keypoints: Keypoints, frame: int) -> FrameFit:
    nothing = ObservedRegions.from_tracks(RegionTracks.unmarked(np.zeros(1), CAMERA.resolution))
    points = ObservedKeypoints.of(keypoints)[np.array([frame])]
    return fit_frame(unmarked_evidence(), nothing, belief, frame, points=points)


def shape_error_mm(posture: Posture, frame: int) -> float:
    """The same with the hips aligned."""
    there = Posture(posture.skeleton, TRUTH.translation[frame], posture.rotations, posture.angles)
    return error_mm(there, frame)


def test_keypoints_alone_lead_from_the_keyframe_before_towards_the_truth() -> None:
    keypoints = detected(1.0)
    before, after = [], []
    for frame in range(10, 45, 5):
        belief = prior_from_keyframes(keyframes(frame - 10), frame, 30.0)
        before.append(error_mm(belief.posture, frame))
        after.append(error_mm(fit_points(belief, keypoints, frame).posture, frame))
    assert np.mean(after) < 0.45 * np.mean(before)


def test_hints_of_depth_help_from_a_standing_body() -> None:
    with_hints, without = [], []
    for frame in (5, 20, 35):
        keypoints = detected(1.0, hint_std_m=0.02)
        here = keypoints.frame(frame)
        placed = place_standing(BODY, CAMERA, frame, keypoints=here)
        belief = prior_from_keyframes((Keyframe(0, placed),), 60, 30.0)
        with_hints.append(shape_error_mm(fit_points(belief, keypoints, frame).posture, frame))
        without.append(shape_error_mm(fit_points(belief, keypoints.without_hints(), frame).posture, frame))
    assert np.mean(with_hints) < 0.9 * np.mean(without)


def test_left_taken_for_right_is_seen_through() -> None:
    keypoints = detected(1.0)
    mirror = [NAMES.index(mirrored_point(name)) for name in NAMES]
    wrong = replace(keypoints, pixel=keypoints.pixel[:, mirror], score=keypoints.score[:, mirror])
    belief = prior_from_keyframes(keyframes(20), 26, 30.0)
    right, found = (fit_points(belief, each, 26) for each in (keypoints, wrong))
    assert error_mm(found.posture, 26) == pytest.approx(error_mm(right.posture, 26), abs=1.0)


def test_a_keypoint_on_another_thing_is_named_and_does_no_harm() -> None:
    keypoints = detected(1.0)
    pixel = np.array(keypoints.pixel)
    pixel[:, NAMES.index("wrist.L")] += 80.0
    belief = prior_from_keyframes(keyframes(20), 26, 30.0)
    found = fit_points(belief, replace(keypoints, pixel=pixel), 26)
    assert found.off.points == ("wrist.L",)
    assert error_mm(found.posture, 26) < 1.3 * error_mm(fit_points(belief, keypoints, 26).posture, 26) + 5.0


def test_the_standing_body_goes_where_keypoints_are() -> None:
    keypoints = detected(1.0)
    placed = place_standing(BODY, CAMERA, 0, keypoints=keypoints.frame(0))
    camera_place = CAMERA.pose(0)[1]
    far = np.linalg.norm(TRUTH.translation[0] - camera_place)
    assert np.linalg.norm(placed.translation - camera_place) == pytest.approx(far, rel=0.12)
    shown, _ = CAMERA.project(placed.translation, 0)
    true, _ = CAMERA.project(TRUTH.translation[0], 0)
    assert np.linalg.norm(shown - true) < 15.0
