"""The cost of markers that should be seen and are not."""

from dataclasses import replace

import numpy as np
from _scene import BODY, CAMERA, SEGMENTS, exercise, film
from keymark.core.arrays import Array
from keymark.core.body.posture import Posture
from keymark.core.estimate.clip_problem import ClipProblem
from keymark.core.estimate.clip_state import ClipState
from keymark.core.estimate.unseen_markers import findable_share, missed_share, unseen_cost
from keymark.core.estimate.whole_clip import estimate_whole_clip
from keymark.core.footage.region_tracks import RegionTracks
from keymark.core.prior.interpolation import interpolate
from keymark.core.prior.keyframes import Keyframe
from keymark.core.progress import run

FRAMES, SHIN = 46, 4
TRUTH = exercise(FRAMES)
POSED = (0, 15, 30, 45)
GONE = np.arange(20, 25)


def without(frames: np.ndarray) -> RegionTracks:
    """The markers' regions, of which the right shin's is missing in some frames."""
    tracks = film(TRUTH, 0.2)
    lost = np.zeros((FRAMES, len(SEGMENTS)), dtype=bool)
    lost[frames, SHIN] = True
    return replace(
        tracks,
        centroid=np.where(lost[..., None], np.nan, tracks.centroid),
        area=np.where(lost, np.nan, tracks.area),
        quality=np.where(lost, 0.0, tracks.quality),
    )


def problem(frames: np.ndarray) -> ClipProblem:
    """The clip's problem."""
    keyframes = tuple(Keyframe(index, TRUTH[index : index + 1][0]) for index in POSED)
    prior = interpolate(keyframes, FRAMES)
    return run(estimate_whole_clip(BODY, CAMERA, without(frames), SEGMENTS, prior, POSED)).problem


def state(clip: ClipProblem, posture: Posture) -> ClipState:
    """The state of all frames at given postures."""
    variation = np.linalg.solve(clip.factor, posture.minus(clip.prior).T).T
    features = clip.observed.quality.shape[1] * 5
    return ClipState(
        BODY, clip.prior, np.arange(FRAMES), clip.factor, variation, np.zeros((FRAMES, features))
    )


def cost_of(clip: ClipProblem, postures: Posture) -> Array:
    """What the markers that are not seen cost in each frame of a motion."""
    return unseen_cost(clip, state(clip, postures), findable_share(clip))


def test_a_marker_in_plain_sight_that_is_not_seen_costs() -> None:
    """In the frames in which it is gone, and nowhere else."""
    clip = problem(GONE)
    cost = cost_of(clip, TRUTH)
    assert (cost[GONE] > 2.0).all()
    assert np.delete(cost, GONE).max() < 0.5


def test_a_marker_that_keyframes_miss_as_well_tells_little() -> None:
    """Its color is no good, or its sleeve is rolled up."""
    often = problem(np.concatenate([GONE, POSED]))
    seldom = problem(GONE)
    assert missed_share(often)[SHIN] > 3.0 * missed_share(seldom)[SHIN]
    costs = [cost_of(clip, TRUTH)[GONE].sum() for clip in (often, seldom)]
    assert costs[0] < costs[1]


def test_a_marker_that_is_not_seen_for_long_tells_nothing() -> None:
    """Nobody knows whether it could be."""
    gone = np.arange(FRAMES)
    clip = problem(gone)
    assert cost_of(clip, TRUTH).max() < 0.5


def test_out_of_the_picture_nothing_is_expected() -> None:
    """A performer who has walked out costs nothing."""
    clip = problem(GONE)
    aside = np.zeros((FRAMES, TRUTH.to_vector().shape[1]))
    aside[:, 0] = 6.0
    assert cost_of(clip, TRUTH.plus(aside)).max() < 0.1
