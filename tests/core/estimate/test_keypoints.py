"""Keypoints in the whole-clip estimate: what they add, their calibration, and detectors that are wrong."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from _scene import (
    BODY,
    CAMERA,
    LAYOUT,
    SEGMENTS,
    SOURCE,
    belief_in,
    changed,
    detect,
    exercise,
    film,
    in_order,
    lasting,
    point_error_m,
    sides_exchanged,
)
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.detect.keypoints import Keypoints, People, mirror_images
from keymark.core.detect.performer import person_size
from keymark.core.estimate.clip_problem import Seen
from keymark.core.estimate.keypoint_evidence import KeypointEvidence
from keymark.core.estimate.keypoint_fit import keypoint_notes, observed_joints
from keymark.core.estimate.keypoint_trust import (
    HINTS_SHARE,
    doubted_at_changes,
    find_swaps,
    sided_by_pictures,
    upright,
)
from keymark.core.estimate.whole_clip import WholeClipResult, estimate_whole_clip
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Keyframe, interpolate
from keymark.core.progress import run
from keymark.core.terms.keypoints import KeypointModel

FRAMES = 90
TRUTH = exercise(FRAMES)
POSED = (0, 15, 30, 45, 60, 75, 89)
BETWEEN = np.setdiff1d(np.arange(FRAMES), POSED)
PRIOR = interpolate(tuple(Keyframe(i, TRUTH[i]) for i in POSED), FRAMES)
GOOD = detect(TRUTH)
MARKED = film(TRUTH, 0.3)
BARE = RegionTracks.unmarked(np.arange(FRAMES) / 30.0, CAMERA.resolution)


def estimate(
    keypoints: Keypoints | None,
    tracks: RegionTracks = BARE,
    prior: Posture = PRIOR,
    camera: Camera = CAMERA,
    doubt: np.ndarray | None = None,
) -> WholeClipResult:
    worn = SEGMENTS if tracks.names else ()
    seen = Seen(tracks, worn, keypoints)
    believed = belief_in(prior, POSED, doubt)
    job = estimate_whole_clip(BODY, camera, seen, believed)
    return run(job)


def error_mm(result: WholeClipResult | Posture) -> float:
    """Mean error of the points between the keyframes [mm]."""
    posture = result if isinstance(result, Posture) else result.posture
    return float(1e3 * point_error_m(posture, TRUTH)[BETWEEN].mean())


@cache
def with_good() -> WholeClipResult:
    return estimate(GOOD)


@cache
def marked() -> WholeClipResult:
    return estimate(None, MARKED)


@cache
def bare() -> WholeClipResult:
    return estimate(None)


def test_keypoints_alone_beat_interpolation_by_far() -> None:
    assert error_mm(with_good()) < 0.4 * error_mm(PRIOR)
    fit = with_good().keypoints
    assert fit.trust.min() == 1.0
    assert fit.source_trust == {SOURCE: 1.0}
    assert fit.thrown_out.mean() < 0.01
    assert not fit.swapped.any()
    assert np.nanmedian(fit.residual_px) < 2.0
    assert keypoint_notes(fit) == ()


def test_places_and_errors_are_found_at_keyframes() -> None:
    exact = detect(TRUTH, error_m=0.004, place_error_m=0.02, seed=3)
    found = estimate(exact).evidence.keypoints
    usual = KeypointModel.usual(BODY, CAMERA, LAYOUT)
    true = 0.02 * np.random.default_rng(3).normal(size=usual.place.shape)
    assert np.linalg.norm(found.model.place - usual.place - true) < 0.6 * np.linalg.norm(true)
    careless = estimate(detect(TRUTH, error_m=0.03, seed=3)).evidence.keypoints
    assert careless.std_m.mean() > 1.4 * found.std_m.mean()


def test_keyframes_are_judged_without_any_marker() -> None:
    rng = np.random.default_rng(4)
    off = [Keyframe(i, TRUTH[i].plus(rng.normal(0.0, 0.12, HUMAN.dof_count))) for i in POSED]
    precise = detect(TRUTH, error_m=0.008)
    exact, careless = (estimate(precise, prior=p) for p in (PRIOR, interpolate(tuple(off), FRAMES)))
    assert exact.evidence.posing_scale < 0.5
    assert careless.evidence.posing_scale > 2.0 * exact.evidence.posing_scale


def test_markers_gain_and_do_not_change_without_keypoints() -> None:
    assert error_mm(estimate(GOOD, MARKED)) < error_mm(marked())
    none = estimate(Keypoints.none(FRAMES), MARKED)
    np.testing.assert_array_equal(none.posture.translation, marked().posture.translation)
    np.testing.assert_array_equal(none.covariance, marked().covariance)


WRONG = {
    "shuffled": in_order(GOOD, np.random.default_rng(5).permutation(FRAMES)),
    "another person": changed(GOOD, GOOD.pixel[::-1] + [60.0, 0.0]),
    "somewhere else": changed(GOOD, GOOD.pixel + [25.0, -15.0]),
    "at random": changed(GOOD, np.random.default_rng(6).uniform(0.0, 240.0, GOOD.pixel.shape)),
}


@pytest.mark.parametrize("kind", WRONG)
def test_a_detector_that_is_wrong_is_left_out(kind: str) -> None:
    result = estimate(WRONG[kind], MARKED)
    assert error_mm(result) < 1.15 * error_mm(marked())
    assert result.keypoints.source_trust[SOURCE] == 0.0
    assert error_mm(estimate(WRONG[kind])) < 1.15 * error_mm(bare())
    assert "left out" in keypoint_notes(result.keypoints)[0]


def test_a_third_of_the_points_at_random_is_thrown_out() -> None:
    rng = np.random.default_rng(7)
    wild = rng.random(GOOD.pixel.shape[:2]) < 0.3
    elsewhere = rng.uniform(0.0, 240.0, GOOD.pixel.shape)
    result = estimate(changed(GOOD, np.where(wild[..., None], elsewhere, GOOD.pixel)))
    assert error_mm(result) < 1.5 * error_mm(with_good())
    kept = result.keypoints.trust > 0.0
    assert kept.mean() > 0.7
    assert result.keypoints.thrown_out[:, kept][wild[:, kept]].mean() > 0.8
    assert any("thrown out" in note for note in keypoint_notes(result.keypoints))


def test_a_jump_to_another_thing_is_not_averaged() -> None:
    pixel = GOOD.pixel.copy()
    wrist = LAYOUT.index("wrist.L")
    pixel[33:43, wrist] = pixel[33, wrist] + [70.0, 40.0]
    result = estimate(changed(GOOD, pixel))
    assert result.keypoints.thrown_out[33:43, wrist].all()
    assert error_mm(result) < 1.2 * error_mm(with_good())


def test_a_late_detector_is_recognized_as_such() -> None:
    late = in_order(GOOD, np.maximum(np.arange(FRAMES) - 6, 0))
    moving = estimate(late)
    assert moving.keypoints.source_trust[SOURCE] == 0.0
    assert moving.keypoints.lag[SOURCE] in (5, 6, 7)
    assert "late" in keypoint_notes(moving.keypoints)[0]


def test_sides_that_are_exchanged_are_exchanged_back() -> None:
    everywhere = estimate(sides_exchanged(GOOD, np.ones(FRAMES, dtype=bool)))
    assert error_mm(everywhere) == pytest.approx(error_mm(with_good()), rel=0.02)
    assert "throughout" in keypoint_notes(everywhere.keypoints)[0]
    some = np.zeros(FRAMES, dtype=bool)
    some[20:26] = some[50:53] = True
    result = estimate(sides_exchanged(GOOD, some))
    paired = np.array(["." in name for name in LAYOUT])
    np.testing.assert_array_equal(result.keypoints.swapped[:, paired].all(axis=1), some)
    assert error_mm(result) < 1.02 * error_mm(with_good())


def test_legs_alone_may_be_exchanged() -> None:
    legs = np.array([name.startswith(("hip", "knee", "ankle")) for name in LAYOUT])
    some = np.zeros(FRAMES, dtype=bool)
    some[47:56] = True
    turned = sides_exchanged(GOOD, some)
    mixed = changed(GOOD, np.where(legs[:, None], turned.pixel, GOOD.pixel))
    model = KeypointModel.usual(BODY, CAMERA, LAYOUT)
    predicted = model.pixels(BODY.pose(PRIOR), np.arange(FRAMES))
    swapped = find_swaps(mixed, predicted, np.full(FRAMES, 85.0), np.array(POSED), np.arange(FRAMES) / 30.0)
    np.testing.assert_array_equal(swapped, some[:, None] & legs)
    np.testing.assert_array_equal(mixed.exchanged(swapped).pixel, GOOD.pixel)


def test_sides_are_those_that_pictures_show_where_nothing_is_posed() -> None:
    time_s, looks = np.arange(FRAMES) / 30.0, range(5, FRAMES, 11)
    some = np.zeros(FRAMES, dtype=bool)
    some[:52] = True  # for more than half of the clip, from its beginning
    turned = sides_exchanged(GOOD, some)
    shown = {frame: GOOD.pixel[frame] + 1.5 for frame in looks}
    people = People(LAYOUT, SOURCE, CAMERA.resolution, (), in_pictures=shown)
    mended = sided_by_pictures(turned, [people], 1.7, time_s)
    np.testing.assert_array_equal(mended.pixel, GOOD.pixel)
    same = sided_by_pictures(GOOD, [people], 1.7, time_s)
    np.testing.assert_array_equal(same.pixel, GOOD.pixel)
    alone = sided_by_pictures(turned, [replace(people, in_pictures={})], 1.7, time_s)
    np.testing.assert_array_equal(alone.pixel, turned.pixel)


@pytest.mark.parametrize("mistaken", ["one look", "somebody else", "the camera turned"])
def test_sides_that_are_right_stay_where_looks_are_mistaken(mistaken: str) -> None:
    time_s, looks = np.arange(FRAMES) / 30.0, range(5, FRAMES, 11)
    other_side = GOOD.pixel[:, mirror_images(GOOD.names, GOOD.sources)]
    away_px = 0.3 * np.array([float(np.median(person_size(GOOD.pixel))), 0.0])
    shown = {frame: GOOD.pixel[frame] for frame in looks}
    if mistaken == "one look":
        shown[27] = other_side[27]
    elif mistaken == "somebody else":
        shown = {frame: other_side[frame] + away_px for frame in looks}
    else:
        shown = {frame: GOOD.pixel[frame] + away_px for frame in looks}
    people = People(LAYOUT, SOURCE, CAMERA.resolution, (), in_pictures=shown)
    kept = sided_by_pictures(GOOD, [people], 1.7, time_s)
    np.testing.assert_array_equal(kept.pixel, GOOD.pixel)


def test_points_near_a_change_of_sides_count_for_little() -> None:
    time_s = np.arange(FRAMES) / 30.0
    legs = np.array([name.startswith(("hip", "knee", "ankle")) for name in LAYOUT])
    swapped = np.zeros((FRAMES, len(LAYOUT)), dtype=bool)
    swapped[47:56, legs] = True
    hinted = detect(TRUTH, hint_error_m=0.03)
    doubted = doubted_at_changes(hinted, swapped, time_s)
    near = np.zeros(FRAMES, dtype=bool)
    near[[45, 46, 47, 48, 54, 55, 56, 57]] = True
    here = near[:, None] & legs & hinted.seen
    np.testing.assert_array_equal((doubted.score == 0.0) & hinted.seen, here | (hinted.score == 0.0))
    assert np.isnan(doubted.hint_m[here]).all()
    np.testing.assert_array_equal(doubted.hint_m[~here], hinted.hint_m[~here])
    np.testing.assert_array_equal(doubted.pixel, hinted.pixel)
    assert doubted_at_changes(hinted, np.zeros_like(swapped), time_s) is hinted


def test_hints_of_depth_help_and_wrong_ones_do_no_harm() -> None:
    hinted = detect(TRUTH, hint_error_m=0.03)
    error = error_mm(estimate(hinted))
    assert error < 0.9 * error_mm(with_good())
    nonsense = replace(hinted, hint_m=0.2 * lasting(np.random.default_rng(8), hinted.hint_m.shape))
    assert error_mm(estimate(nonsense)) < 1.15 * error_mm(with_good())


def standing_hints(tilt_rad: float) -> Keypoints:
    """A detector's view of somebody who stands with every joint at rest, its depths tilted."""
    pose = BODY.pose(Posture.rest(BODY.skeleton, (3,)))
    model = KeypointModel.usual(BODY, CAMERA, HUMAN.point_names)
    pixel = model.pixels(pose, np.arange(3))
    relative = model.world(pose) - pose.posture.translation[:, None]
    _, sight = CAMERA.rays(pixel[0].mean(axis=0))
    across = np.cross(sight, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    hint = relative @ np.stack([across, np.cross(sight, across), sight], axis=-1)
    sine, cosine = np.sin(tilt_rad), np.cos(tilt_rad)
    hint = hint @ np.array([[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]])
    return Keypoints(HUMAN.point_names, (SOURCE,) * 13, pixel, np.ones((3, 13)), hint)


def test_hints_that_lean_are_turned_by_the_balance() -> None:
    def head_m(keypoints: Keypoints) -> float:
        """How much farther the head is than the ankles."""
        depth = dict(zip(HUMAN.point_names, keypoints.hint_m[1, :, 2], strict=True))
        return depth["head"] - 0.5 * (depth["ankle.L"] + depth["ankle.R"])

    true, leaning = standing_hints(0.0), standing_hints(0.15)
    mended = upright(leaning, CAMERA)
    before, after = (head_m(each) - head_m(true) for each in (leaning, mended))
    assert abs(before) > 0.2
    own = head_m(upright(true, CAMERA)) - head_m(true)  # a rest pose is a little off balance
    assert abs(own) < 0.06
    assert (after - own) / before == pytest.approx(1.0 - HINTS_SHARE, abs=0.02)
    np.testing.assert_array_equal(mended.pixel, leaning.pixel)
    sitting = standing_hints(0.5)
    np.testing.assert_array_equal(upright(sitting, CAMERA).hint_m, sitting.hint_m)


def test_six_tracks_with_long_gaps_are_used() -> None:
    names = ("wrist.L", "wrist.R", "ankle.L", "ankle.R", "head", "knee.L")
    tracks = detect(TRUTH, names=names, error_m=0.004)
    pixel = tracks.pixel.copy()
    pixel[25:70, :2] = np.nan
    result = estimate(changed(tracks, pixel))
    assert error_mm(result) < 0.85 * error_mm(bare())
    assert np.isnan(result.keypoints.residual_px[25:70, 0]).all()
    assert (result.keypoints.weight[25:70, 0] == 0.0).all()


def test_several_sources_are_calibrated_apart() -> None:
    both = Keypoints.side_by_side(
        [GOOD, replace(WRONG["another person"], sources=("tracks",) * len(LAYOUT))], FRAMES
    )
    fit = estimate(both).keypoints
    assert fit.source_trust == {SOURCE: 1.0, "tracks": 0.0}


def test_before_a_moving_camera() -> None:
    matrices = np.repeat(CAMERA.matrix_world[None], FRAMES, axis=0)
    matrices[:, 0, 3] += np.linspace(-0.5, 0.5, FRAMES)
    moving = replace(CAMERA, matrix_world=matrices)
    found = estimate(detect(TRUTH, camera=moving), camera=moving)
    assert error_mm(found) == pytest.approx(error_mm(with_good()), rel=0.3)


def test_errors_are_within_their_interval() -> None:
    inside = []
    for seed in range(3):
        result = estimate(detect(TRUTH, seed=seed))
        jacobian = BODY.points_jacobian(BODY.pose(result.posture))
        spread = jacobian @ result.covariance[:, None] @ np.swapaxes(jacobian, -1, -2)
        sigma = np.sqrt(np.trace(spread, axis1=-2, axis2=-1))
        inside.append((point_error_m(result.posture, TRUTH) < 1.96 * sigma)[BETWEEN].mean())
    assert 0.90 <= np.mean(inside) <= 1.0


def test_a_joint_is_carried_by_the_one_above_and_an_ankle_by_its_shin() -> None:
    joints, seen = observed_joints(with_good().keypoints)
    named = dict(zip(LAYOUT, joints, strict=True))
    assert (named["hip.L"], named["shoulder.R"], named["knee.R"]) == ("pelvis", "girdle.R", "hip.R")
    assert named["ankle.L"] == "shin.L"
    assert seen.mean() > 0.95


def test_two_networks_that_look_at_the_same_pictures_weigh_as_much_as_one() -> None:
    names, other = (*LAYOUT, *LAYOUT), (SOURCE,) * len(LAYOUT) + ("another",) * len(LAYOUT)
    one = KeypointEvidence.usual(BODY, CAMERA, LAYOUT, other[: len(LAYOUT)])
    apart = KeypointEvidence.usual(BODY, CAMERA, names, other)
    both = KeypointEvidence.usual(BODY, CAMERA, names, other, {"another": SOURCE})
    for found in (0.0, 1.0):
        once, alone, beside = (
            (evidence.errors(np.array([found]))[0] ** -2.0).sum() for evidence in (one, apart, both)
        )
        assert beside == pytest.approx(once) and alone == pytest.approx(2.0 * once)
