"""Postures of one frame from nothing: whichever way the body faces, and what contradicts by name."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from _scene import BODY, CAMERA, MODEL, exercise, film
from keymark.core.body.body_volume import lower_sole_m
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture, yawed_at
from keymark.core.detect.keypoints import Keypoints
from keymark.core.errors import InputError
from keymark.core.estimate.clip_problem import uncalibrated
from keymark.core.estimate.keypoint_evidence import KeypointEvidence
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.poses.frame import FramePoses, find_frame_poses
from keymark.core.poses.frame_search import FrameShown
from keymark.core.poses.part_pools import part_pools, usable_libraries
from keymark.core.prior.frame_prior import prior_from_keyframes
from keymark.core.prior.keyframes import Keyframe
from keymark.core.prior.library import Library
from keymark.core.prior.registry import SHIPPED, find_libraries
from keymark.core.prior.texts import EVERY_LIBRARY
from keymark.core.terms.keypoints import KeypointModel, ObservedKeypoints

TURNS = {"front": 0.0, "left": 90.0, "behind": 180.0, "right": -90.0}
NAMES = tuple(point.name for point in BODY.skeleton.points)
SOURCES = ("detector",) * len(NAMES)
Libraries = tuple[Library, ...]


@pytest.fixture(scope="module")
def libraries() -> Libraries:
    return find_libraries(EVERY_LIBRARY, (SHIPPED,))


def performed(turn_deg: float, frame: int = 24) -> Posture:
    """A batch of one: a moment of an exercise, turned about the vertical, on the floor."""
    moment = exercise(45)[np.array([frame])]
    placed = moment.translation - np.array([0.0, 0.0, 1.0]) * lower_sole_m(BODY, moment)[:, None]
    return yawed_at(moment, np.radians(turn_deg), placed)


def shown(tracks: RegionTracks, keypoints: Keypoints | None = None) -> FrameShown:
    keypoints = keypoints or Keypoints.none(1)
    usual = KeypointEvidence.usual(BODY, CAMERA, keypoints.names, keypoints.sources)
    evidence = replace(uncalibrated(MODEL), keypoints=usual)
    return FrameShown(evidence, 0, tracks, keypoints, ObservedKeypoints.of(keypoints))


def detected(posture: Posture, seed: int) -> Keypoints:
    """Keypoints of a posture as a good detector sees them, without depths."""
    model = KeypointModel.usual(BODY, CAMERA, NAMES)
    pixel = model.pixels(BODY.pose(posture), np.zeros(1, dtype=np.intp))
    pixel = pixel + np.random.default_rng(seed).normal(scale=1.5, size=pixel.shape)
    return Keypoints(NAMES, SOURCES, pixel, np.ones(pixel.shape[:2]), np.full((*pixel.shape[:2], 3), np.nan))


def errors_m(found: FramePoses, truth: Posture, body: Body = BODY) -> list[float]:
    """Mean distance of the points from the truth, hips aligned, of each candidate."""
    wanted = body.points(body.pose(truth))[0] - truth.translation[0]
    postures = Posture.stack([each.posture for each in found.candidates])
    points = body.points(body.pose(postures)) - postures.translation[:, None]
    return [float(each) for each in np.linalg.norm(points - wanted, axis=-1).mean(axis=-1)]


def moved_to(tracks: RegionTracks, marker: int, pixel: tuple[float, float]) -> RegionTracks:
    centroid = np.array(tracks.centroid)
    centroid[:, marker] = pixel
    return replace(tracks, centroid=centroid)


@pytest.fixture(scope="module")
def by_markers(libraries: Libraries) -> Callable[[str], FramePoses]:
    """A function from a side to what markers alone show of a body turned there, found once."""

    @cache
    def found(side: str) -> FramePoses:
        return find_frame_poses(shown(film(performed(TURNS[side]), noise_px=0.3, seed=1)), libraries)

    return found


def hidden(tracks: RegionTracks) -> RegionTracks:
    nothing = np.full_like(tracks.centroid, np.nan)
    return replace(tracks, centroid=nothing, quality=np.zeros_like(tracks.quality))


@pytest.mark.parametrize("side", TURNS)
def test_markers_alone_find_a_body_from_any_side(side: str, by_markers: Callable[[str], FramePoses]) -> None:
    found = by_markers(side)
    assert min(errors_m(found, performed(TURNS[side]))) < 0.13
    assert found.contradictions == ()
    assert len(found.candidates) > 1


@pytest.mark.parametrize("side", TURNS)
def test_keypoints_alone_find_a_body_from_any_side(side: str, libraries: Libraries) -> None:
    truth = performed(TURNS[side])
    found = find_frame_poses(shown(hidden(film(truth)), detected(truth, 2)), libraries)
    assert min(errors_m(found, truth)) < 0.10


def test_candidates_differ_and_their_confidences_are_probabilities(
    by_markers: Callable[[str], FramePoses],
) -> None:
    found = by_markers("left")
    postures = Posture.stack([each.posture for each in found.candidates])
    points = BODY.points(BODY.pose(postures)) - postures.translation[:, None]
    apart = np.linalg.norm(points[:, None] - points, axis=-1).mean(axis=-1)
    assert apart[~np.eye(len(points), dtype=bool)].min() > 0.06
    assert all(0.0 < each.confidence < 1.0 for each in found.candidates)


@pytest.mark.parametrize("marker", [1, 3, 4])
def test_a_region_that_nobody_wears_is_named_and_left_out(
    marker: int, libraries: tuple[Library, ...]
) -> None:
    truth = performed(0.0)
    tracks = moved_to(film(truth, noise_px=0.3, seed=3), marker, (22.0, 30.0))
    found = find_frame_poses(shown(tracks), libraries)
    assert tracks.names[marker] in found.contradictions
    assert min(errors_m(found, truth)) < 0.19


def test_keypoints_that_no_body_explains_lead_to_an_answer_all_the_same(libraries: Libraries) -> None:
    truth = performed(0.0)
    seen = detected(truth, 6)
    wild = np.random.default_rng(6).uniform(20.0, 220.0, size=seen.pixel.shape)
    found = find_frame_poses(shown(hidden(film(truth)), replace(seen, pixel=wild)), libraries)
    assert found.contradictions
    assert found.candidates[0].confidence < 0.4


def test_between_good_keyframes_their_posture_stays(libraries: Libraries) -> None:
    motion = exercise(45)
    tracks = film(motion, noise_px=0.3, seed=4)
    belief = prior_from_keyframes((Keyframe(12, motion[12]), Keyframe(36, motion[36])), 24, 30.0)
    found = find_frame_poses(shown(tracks.frame(24)), libraries, None, belief)
    assert errors_m(found, motion[np.array([24])])[0] < 0.06


def test_keyframes_that_contradict_the_frame_are_overruled(libraries: Libraries) -> None:
    truth = performed(90.0)
    wrong = performed(-90.0)
    belief = prior_from_keyframes((Keyframe(0, wrong[0]),), 30, 30.0)
    found = find_frame_poses(
        shown(film(truth, noise_px=0.3, seed=5), detected(truth, 5)), libraries, None, belief
    )
    assert min(errors_m(found, truth)) < 0.10


def test_a_frame_that_shows_nothing_says_so(libraries: Libraries) -> None:
    with pytest.raises(InputError, match="neither a marker nor a keypoint is seen"):
        find_frame_poses(shown(hidden(film(performed(0.0)))), libraries)


def test_a_candidate_is_named_by_the_posture_whose_trunk_it_has(libraries: Libraries) -> None:
    pools = part_pools(usable_libraries(libraries), BODY)
    for row in range(0, len(pools.torsos), 5):
        turned = yawed_at(pools.torsos.posture[[row]], np.array([0.7]), np.array([[1.0, 2.0, 0.9]]))[0]
        assert pools.nearest(turned) == pools.names[pools.torsos.source[row]]
