"""What a person judges a motion by."""

from dataclasses import fields, replace

import numpy as np
import pytest
from _performances import made_up_review
from _synthetic_take import write_synthetic_take
from keymark.core.api import reconstruct
from keymark.core.body.fingers import Hands
from keymark.core.detect.keypoints import Keypoints, People, SeenPeople
from keymark.core.progress import run
from keymark.core.review.compared_keypoints import ComparedKeypoints
from keymark.core.review.frame_evidence import contour_sight, used_evidence
from keymark.core.review.review import Review, review
from keymark.core.take.conversion_settings import METHODS
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take, with_evidence
from keymark.core.take.take_file import read_take
from keymark.core.terms.head import ObservedHeads

ASIDE = 0.04 * np.eye(34)[0]
"""A step of the posture that moves the performer by four centimeters."""


def same(first: Review | ComparedKeypoints, second: Review | ComparedKeypoints) -> bool:
    """Whether two reviews hold the same, outlines and keypoints to single precision."""
    for field in fields(first):
        one, other = getattr(first, field.name), getattr(second, field.name)
        if isinstance(one, ComparedKeypoints):
            if not same(one, other):
                return False
        elif not isinstance(one, np.ndarray):
            if one != other:
                return False
        elif not np.allclose(one, other, rtol=1e-6, atol=1e-6, equal_nan=True):
            return False
    return True


def test_a_review_comes_back_from_its_arrays() -> None:
    review = made_up_review()
    arrays = review.to_arrays()
    assert all(array.dtype != object for array in arrays.values())
    again = Review.from_arrays(arrays)
    assert same(again, review)
    assert again.weak_frames == review.weak_frames
    assert again.marker_names == review.marker_names and again.size == (160, 120)


def test_a_review_that_was_kept_before_there_were_keypoints_has_none() -> None:
    arrays = made_up_review().to_arrays()
    new = ("weak_point", "contours", "unsure")
    old = {name: value for name, value in arrays.items() if name[:9] != "keypoint_" and name not in new}
    again = Review.from_arrays(old)
    assert again.keypoints.names == () and again.keypoints.seen.shape == (13, 0, 2)
    assert again.contours.shape == (13, 0, 4, 2)
    assert again.weak_frames == made_up_review().weak_frames
    with pytest.raises(KeyError):
        Review.from_arrays({name: value for name, value in arrays.items() if name != "keypoint_swapped"})


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    return read_take(write_synthetic_take(tmp_path_factory.mktemp("take"), frames=24, keyframe_every=8))


@pytest.mark.parametrize("method", METHODS)
def test_a_reconstruction_of_every_method_can_be_reviewed(take: Take, method: str) -> None:
    result = run(reconstruct(take, method))
    seen = run(review(take, result, np.arange(24) + 1.0))
    assert seen.observed.shape[:2] == seen.predicted.shape[:2] == (24, 5)
    centers = [np.nanmean(outline, axis=2) for outline in (seen.observed, seen.predicted)]
    assert np.nanmedian(np.linalg.norm(centers[0] - centers[1], axis=-1)) < 3.0
    known = method != "interpolation"
    assert np.isfinite(seen.confidence).all() == known and np.isfinite(seen.sigma_m).all() == known
    if known:
        assert seen.confidence[0] > seen.confidence[4] > 0.0
    assert same(Review.from_arrays(seen.to_arrays()), seen)


def test_the_motion_that_was_found_is_the_one_that_is_shown(take: Take) -> None:
    result = run(reconstruct(take))
    seen = run(review(take, result, np.arange(24) + 1.0))
    pixels, _ = result.model.camera.project(seen.points)
    assert seen.image_points == pytest.approx(pixels)


def test_hands_and_heads_whose_turn_is_hardly_seen_are_told_frame_by_frame(take: Take) -> None:
    result = run(reconstruct(take))
    assert not run(review(take, result, np.arange(24))).unsure.any()  # nobody looked
    sure, std_rad = np.full((24, 2), 0.8), np.full(24, 0.1)
    sure[5, 1], std_rad[[7, 8]] = 0.6, (np.inf, 0.4)
    hands = Hands(np.zeros((24, 2, 5)), np.zeros((24, 2, 3)), sure)
    heads = ObservedHeads(np.broadcast_to(np.eye(3), (24, 3, 3)), std_rad)
    solution = result.solution
    data = replace(solution.problem.data)
    vars(data)["heads"] = heads
    solution = replace(solution, problem=replace(solution.problem, data=data))
    looked = replace(result, motion=replace(result.motion, hands=hands), solution=solution)
    assert np.argwhere(run(review(take, looked, np.arange(24))).unsure).tolist() == [[5, 1], [7, 2], [8, 2]]


def keypoints_of(take: Take, motion: Motion, names: tuple[str, ...]) -> Keypoints:
    """What a detector would see of a motion: points two pixels beside the joints."""
    points = motion.points[:, [take.body.skeleton.point_names.index(name) for name in names]]
    pixel = take.camera.project(points)[0] + [2.0, 0.0]
    noise = np.random.default_rng(6).normal(scale=0.3, size=pixel.shape)
    unknown = np.full((*pixel.shape[:2], 3), np.nan)
    return Keypoints(
        names, ("a detector",) * len(names), pixel + noise, np.full(pixel.shape[:2], 0.9), unknown
    )


@pytest.mark.parametrize("kinds", [("keypoints",), ("contours",), ("markers", "keypoints")])
def test_any_evidence_is_reviewed(take: Take, kinds: tuple[str, ...]) -> None:
    frames = 24
    truth = run(reconstruct(take)).motion
    names = ("wrist.L", "wrist.R", "ankle.L", "ankle.R")
    keypoints = keypoints_of(take, truth, names)
    seen = tuple(
        SeenPeople(pixel[None], score[None], hint[None])
        for pixel, score, hint in zip(keypoints.pixel, keypoints.score, keypoints.hint_m, strict=True)
    )
    people = People(names, "a detector", take.camera.resolution, seen)
    partly = with_evidence(replace(take, keypoints=(people,)), kinds)
    result = run(reconstruct(partly))
    found = run(review(partly, result, np.arange(frames) + 1.0))
    assert len(found.marker_names) == (5 if "markers" in kinds else 0)
    assert found.observed.shape == found.predicted.shape
    assert (found.contours.shape[1] > 0) == (kinds == ("contours",))
    assert found.keypoints.names == (names if "keypoints" in kinds else ())
    if "keypoints" in kinds:
        assert np.nanmedian(found.keypoints.distance_px) < 3.0
        assert np.nanmedian(found.keypoints.misfit) < 4.0
        assert not found.keypoints.thrown_out.all(axis=0).any()
    assert np.isfinite(found.confidence).all() and found.confidence[0] > found.confidence[4]
    used = used_evidence(result)
    assert (len(used.markers), len(used.keypoints)) == (len(partly.markers), int("keypoints" in kinds))
    assert used.contours == (partly.contours and result.solution.contours is not None)
    for said in used.keypoints:
        assert said.points == names and 0.5 < said.believed <= 1.0
    if used.markers:
        by_filter = run(reconstruct(partly, "ekf", result.reading))
        filtered = used_evidence(by_filter)
        assert (filtered.markers, filtered.keypoints, filtered.contours) == (used.markers, (), False)
        beside = run(review(partly, by_filter, np.arange(frames) + 1.0)).keypoints
        assert beside.names == names and np.nanmedian(beside.distance_px) < 6.0 and not beside.swapped.any()
    assert same(Review.from_arrays(found.to_arrays()), found)


def test_contours_judge_a_motion_only_where_no_marker_does(take: Take) -> None:
    bare = with_evidence(take, ("contours",))
    good = run(reconstruct(bare))
    moved = replace(good.motion, posture=good.motion.posture.plus(ASIDE))
    bad = replace(good, motion=moved)
    sights = [run(contour_sight(result)) for result in (good, bad)]
    assert sights[0].segments == sights[1].segments and "shin.L" in sights[0].segments
    assert np.nanmedian(sights[1].misfit) > 2.0 * np.nanmedian(sights[0].misfit)
    believed = [run(review(bare, result, np.arange(24) + 1.0)).confidence.mean() for result in (good, bad)]
    assert believed[1] < believed[0]
    assert run(contour_sight(run(reconstruct(take)))).segments == ()


def test_few_keyframes_are_told_with_the_frames_that_lack_one(take: Take) -> None:
    few = replace(take, keyframes=(take.keyframes[0], take.keyframes[-1]))
    result = run(reconstruct(few, "interpolation"))
    worst = run(review(few, result, np.arange(24) + 1.0)).weak_frames[0]
    assert 6 <= worst.index <= 17
