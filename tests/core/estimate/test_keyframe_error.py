"""Errors of keyframes: posed, found; and of postures that nothing observes."""

from functools import cache

import numpy as np
import pytest
from _scene import BODY, CAMERA, MODEL, SEGMENTS, belief_in, exercise, film, no_points, point_error_m
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.detect.keypoints import Keypoints
from keymark.core.estimate.belief import (
    PLACE_DEPTH_STD_M,
    PLACE_STD_M,
    Belief,
    found_covariance,
    joint_std_rad,
)
from keymark.core.estimate.clip_problem import Seen, uncalibrated
from keymark.core.estimate.keyframe_evidence import (
    SeenAtKeyframes,
    placement_values,
    read_belief,
    read_keyframes,
)
from keymark.core.estimate.performer_placement import (
    found_ankle_m,
    standing_ankle_m,
)
from keymark.core.estimate.sigma import (
    GRACE_S,
    LIMB_STD_RAD,
    SURE_STD_M,
    UNSURE_STD_M,
    across_sight,
    guessed_depth_std_m,
    place_depth_std_m,
    undetermined_covariance,
    unobserved_variance,
)
from keymark.core.estimate.whole_clip import WholeClipResult, estimate_whole_clip
from keymark.core.prior.keyframes import Keyframe, interpolate
from keymark.core.progress import run
from keymark.core.terms.depths import DEPTH_STD_M
from keymark.core.terms.regions import ObservedRegions, limb_widths

FRAMES = 60
TRUTH = exercise(FRAMES)
INDEX = np.arange(0, FRAMES, 8)
TRACKS = film(TRUTH, 0.3)


def off(seed: int = 2) -> Posture:
    """The true postures at the keyframes as a library has them: another performer's, each a little off."""
    rng = np.random.default_rng(seed)
    covariance = found_covariance(TRUTH[INDEX], CAMERA, INDEX)
    factor = np.linalg.cholesky(covariance)
    error = 0.4 * rng.normal(size=(1, BODY.skeleton.dof_count)) + 0.3 * rng.normal(size=(len(INDEX), 34))
    return TRUTH[INDEX].plus((factor @ error[..., None])[..., 0])


def belief(postures: Posture, doubt: np.ndarray | None = None) -> Belief:
    """The belief in keyframes that were found, or posed where there is no doubt."""
    keyframes = tuple(Keyframe(int(i), postures[row]) for row, i in enumerate(INDEX))
    return belief_in(interpolate(keyframes, FRAMES), tuple(INDEX.tolist()), doubt)


def estimate(postures: Posture, doubt: np.ndarray | None) -> WholeClipResult:
    return run(estimate_whole_clip(BODY, CAMERA, Seen(TRACKS, SEGMENTS), belief(postures, doubt)))


@cache
def as_found() -> WholeClipResult:
    """The estimate through keyframes that are all found."""
    return estimate(off(), np.ones(len(INDEX)))


def test_found_keyframes_are_left_behind_where_posed_ones_would_be_held_on_to() -> None:
    both = estimate(off(), None), as_found()
    errors = [point_error_m(found.posture, TRUTH).mean() for found in both]
    assert errors[1] < 0.9 * errors[0]
    stated = [np.sqrt(np.trace(found.covariance[:, :3, :3], axis1=1, axis2=2)).mean() for found in both]
    assert stated[1] > 1.25 * stated[0]


def test_found_keyframes_calibrate_nothing() -> None:
    evidence = as_found().evidence
    np.testing.assert_array_equal(
        placement_values(evidence.model.placements), placement_values(MODEL.placements)
    )
    assert evidence.model.camera.lens_mm == CAMERA.lens_mm


def test_posed_keyframes_calibrate_and_found_ones_beside_them_do_not() -> None:
    doubt = np.where(np.arange(len(INDEX)) % 2, 0.7, 0.0)
    postures, observed = off(), ObservedRegions.from_tracks(TRACKS)[INDEX]
    width = limb_widths(MODEL, postures.translation, INDEX)
    usual, posed = uncalibrated(MODEL).keypoints, np.flatnonzero(doubt == 0.0)
    every = SeenAtKeyframes(INDEX, postures, observed, width, usual, no_points(len(INDEX)))
    mixed = run(read_belief(MODEL, every, belief(postures, doubt)))
    alone = run(read_keyframes(MODEL, every[posed]))
    ours, theirs = (placement_values(one.model.placements) for one in (mixed, alone))
    np.testing.assert_allclose(ours, theirs, rtol=1e-9)
    np.testing.assert_allclose(mixed.information[posed], alone.information, rtol=1e-9)
    covariance = np.linalg.inv(mixed.information[1])
    assert covariance[10, 10] == pytest.approx(0.49 * joint_std_rad(BODY.skeleton)[10] ** 2)


def test_the_place_is_less_known_along_the_line_of_sight() -> None:
    place = found_covariance(TRUTH[INDEX], CAMERA, INDEX)[0, :3, :3]
    values = np.sqrt(np.linalg.eigvalsh(place))
    np.testing.assert_allclose(values, [PLACE_STD_M, PLACE_STD_M, PLACE_DEPTH_STD_M])


def test_depths_count_near_posed_keyframes_only() -> None:
    noise = belief_in(TRUTH[:12], (0, 10), np.array([0.0, 1.0])).depth_std_m
    assert noise[0] == pytest.approx(DEPTH_STD_M)
    assert (np.diff(noise[:11]) > 0.0).all() and noise[11] == noise[10] > 4.0 * noise[0]


def test_what_is_undecided_lies_along_the_line_of_sight_and_vanishes_at_posed_keyframes() -> None:
    points = BODY.points(BODY.pose(TRUTH[:11]))
    sight = points[10, 4] - CAMERA.pose()[1]
    sight /= np.linalg.norm(sight)
    found = []
    for confidence in (0.0, 0.5, 1.0):
        sure = np.array([1.0, confidence])
        spread = undetermined_covariance(points, CAMERA, np.array([0, 10]), np.array([0.0, 1.0]), sure)
        assert np.abs(spread[0]).max() == 0.0
        along = sight @ spread[10, 4] @ sight
        across = 0.5 * (np.trace(spread[10, 4]) - along)
        found.append(np.sqrt([across, along]))
        assert spread[10, 4] @ sight == pytest.approx(along * sight)
    np.testing.assert_allclose(found[0], UNSURE_STD_M)
    np.testing.assert_allclose(found[2], SURE_STD_M)
    assert (found[0] > found[1]).all() and (found[1] > found[2]).all()


def test_a_guess_of_depths_tells_how_far_off_found_depths_are() -> None:
    points = BODY.points(BODY.pose(TRUTH[:11]))
    depth = CAMERA.depth(points, np.arange(11)[:, None])
    hips = [HUMAN.point_names.index(f"hip.{side}") for side in "LR"]
    wrist = HUMAN.point_names.index("wrist.R")
    hint = np.full((11, 3, 3), np.nan)
    hint[:, 0, 2] = depth[:, wrist] - depth[:, hips].mean(axis=1) + 0.1
    hint[:, 1:, 2] = 5.0  # other points than the thirteen, and one that is never guessed
    hint[:, 2] = np.nan
    names, pixel = ("wrist.R", "heel.L", "knee.L"), np.zeros((11, 3, 2))
    seen = Keypoints(names, ("network",) * 3, pixel, np.ones((11, 3)), hint)
    guessed_m = guessed_depth_std_m(points, CAMERA, seen)
    assert guessed_m == pytest.approx(0.1 / np.sqrt(2.0))
    assert guessed_depth_std_m(points, CAMERA, seen.without_hints()) is None
    index, doubt = np.array([0, 10]), np.array([0.0, 1.0])
    spread = undetermined_covariance(points, CAMERA, index, doubt, np.ones(2), guessed_std_m=guessed_m)
    own = across_sight(
        np.broadcast_to(0.05**2 * np.eye(3), spread.shape), points, CAMERA, doubt[[0] * 10 + [1]]
    )
    np.testing.assert_allclose(own[0, 4], 0.05**2 * np.eye(3), atol=1e-12)
    sight = CAMERA.sight(points, np.arange(11)[:, None])[10, 4]
    assert sight @ (own + spread)[10, 4] @ sight == pytest.approx(0.005)
    assert np.trace((own + spread)[10, 4]) == pytest.approx(0.005 + 2.0 * (0.05**2 + SURE_STD_M[0] ** 2))


def test_a_performer_whose_distance_is_unsure_is_so_along_the_line_of_sight() -> None:
    points = BODY.points(BODY.pose(TRUTH[:11]))
    index, scale, sure = np.array([0, 10]), np.ones(2), np.ones(2)
    near, far = (undetermined_covariance(points, CAMERA, index, scale, sure, each) for each in (0.0, 0.3))
    added = np.trace(far - near, axis1=-2, axis2=-1)
    np.testing.assert_allclose(added, 0.09)


def test_the_lower_ankle_follows_found_postures_into_flight_and_rests_on_the_floor() -> None:
    standing = TRUTH[np.zeros(6, dtype=np.intp)]
    lift = np.zeros((6, BODY.skeleton.dof_count))
    lift[3, 2] = 0.4
    found = standing.plus(lift)
    low = BODY.points(BODY.pose(found))[:, ANKLES, 2].min(axis=1)[0]
    for off in (-0.11, 0.0, 0.11, 0.13):  # of a known floor from where these feet stand
        floor_m = low - standing_ankle_m(BODY) + off
        heights = found_ankle_m(BODY, found, np.arange(0, 30, 5), 30, floor_m)
        assert heights[0] == pytest.approx(low + off * (0.0 < off < 0.12), abs=1e-6)
        assert heights[15] == pytest.approx(low + 0.4, abs=1e-6)


ANKLES = [BODY.skeleton.point_names.index(f"ankle.{side}") for side in "LR"]
WORN = ("trunk", "forearm.L", "shin.L")
TIME_S = np.arange(90) / 30.0


def open_of(visible: np.ndarray, keyframes: list[int]) -> np.ndarray:
    """(F, D) variances."""
    index = np.array(keyframes, dtype=np.intp)
    return unobserved_variance(HUMAN, WORN, visible, index, TIME_S)


@pytest.mark.parametrize("keyframes", [[0], [0, 45, 89]])
def test_nothing_is_open_where_markers_are_seen(keyframes: list[int]) -> None:
    visible = np.ones((90, 3), dtype=bool)
    visible[30 : 29 + int(2 * 30 * GRACE_S), 1] = False
    seen = [HUMAN.dof_names.index(name) for name in ("elbow.L.flexion", "knee.L.flexion", "waist.rotation_x")]
    assert open_of(visible, keyframes)[:, seen].max() == 0.0


def test_a_limb_is_open_long_after_it_was_seen_last_and_no_other() -> None:
    visible = np.ones((90, 3), dtype=bool)
    visible[20:, 1] = False
    variance = open_of(visible, [0, 80])
    elbow, knee = (variance[:, HUMAN.dof_names.index(f"{name}.L.flexion")] for name in ("elbow", "knee"))
    assert knee.max() == 0.0 and elbow[:20].max() == elbow[80] == 0.0
    assert (np.diff(elbow[28:50]) > 0.0).all() and 0.3 < np.sqrt(elbow.max()) < 1.0


def test_a_knee_tells_of_the_thigh_and_nothing_of_the_shin() -> None:
    at = [
        HUMAN.dof_names.index(f"{name}.L.{dof}") for name, dof in (("hip", "rotation_x"), ("knee", "flexion"))
    ]
    variance = unobserved_variance(
        HUMAN, ("hip.L",), np.ones((90, 1), dtype=bool), np.zeros(0, dtype=np.intp), TIME_S
    )
    assert variance[:, at[0]].max() == 0.0
    np.testing.assert_allclose(np.sqrt(variance[:, at[1]]), LIMB_STD_RAD, rtol=1e-3)
    assert variance[:, :3].max() == 0.0


def test_a_floor_that_contradicts_the_size_makes_the_place_uncertain() -> None:
    points = BODY.points(BODY.pose(TRUTH))
    agreed, off_it = (
        place_depth_std_m(points, points[..., 2].min(axis=1), CAMERA, over_m) for over_m in (0.0, 0.2)
    )
    step = np.sqrt(off_it**2 - agreed**2)
    assert (step > 0.0).all()
    twice = place_depth_std_m(points, points[..., 2].min(axis=1), CAMERA, -0.4)
    np.testing.assert_allclose(np.sqrt(twice**2 - agreed**2), 2.0 * step)
