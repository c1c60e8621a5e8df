"""The whole-clip estimate on footage whose truth is known because the region model itself filmed it."""

import gc
from dataclasses import replace
from types import FunctionType, ModuleType

import numpy as np
import pytest
from _scene import BODY, CAMERA, SEGMENTS, belief_in, exercise, film, point_error_m
from keymark.core.body.posture import Posture
from keymark.core.estimate.belief import posing_covariance
from keymark.core.estimate.clip_problem import Seen
from keymark.core.estimate.whole_clip import WholeClipResult, estimate_whole_clip
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Keyframe, interpolate
from keymark.core.progress import Preview, run

FRAMES = 46
POSED = (0, 9, 18, 27, 36, 45)
TRUTH = exercise(FRAMES)
TURNS = np.where(np.arange(BODY.skeleton.dof_count) < 3, 0.0, 1.0)


def solve(prior: Posture, tracks: RegionTracks) -> WholeClipResult:
    job = estimate_whole_clip(BODY, CAMERA, Seen(tracks, SEGMENTS), belief_in(prior, POSED))
    fractions = []
    while True:
        try:
            done = next(job)
            if not isinstance(done, Preview):
                fractions.append(done)
        except StopIteration as stop:
            assert fractions == sorted(fractions) and 0.0 <= fractions[0] < fractions[-1] <= 1.0
            return stop.value


def kept_bytes(result: WholeClipResult) -> int:
    """Size of all arrays that a result keeps alive, each counted once."""
    waiting, known, total = [result], set(), 0
    while waiting:
        one = waiting.pop()
        if id(one) in known or isinstance(one, type | ModuleType | FunctionType):
            continue
        known.add(id(one))
        waiting += gc.get_referents(one)
        if isinstance(one, np.ndarray) and one.base is None:
            total += one.nbytes
        elif isinstance(one, np.ndarray):
            waiting.append(one.base)
    return total


def prior_from(posed: Posture) -> Posture:
    """The interpolation of postures at the posed frames."""
    keyframes = tuple(Keyframe(index, posed[i]) for i, index in enumerate(POSED))
    return interpolate(keyframes, FRAMES)


def posed_by_hand(seed: int, scale: float = 1.0) -> Posture:
    """The true keyframes with a person's posing error."""
    rng = np.random.default_rng(seed)
    exact = TRUTH[np.array(POSED)]
    factor = np.linalg.cholesky(posing_covariance(BODY, BODY.pose(exact)))
    return exact.plus(scale * (factor @ rng.normal(size=(*factor.shape[:-1], 1)))[..., 0])


@pytest.fixture(scope="module")
def exact() -> WholeClipResult:
    """The estimate from exact keyframes and footage of half a pixel of noise."""
    return solve(prior_from(TRUTH[np.array(POSED)]), film(TRUTH, 0.3))


def test_footage_corrects_the_interpolation_between_exact_keyframes(exact: WholeClipResult) -> None:
    before = point_error_m(prior_from(TRUTH[np.array(POSED)]), TRUTH).mean()
    after = point_error_m(exact.posture, TRUTH).mean()
    assert after < 0.6 * before
    assert after < 0.010


def test_what_is_kept_of_a_frame_lets_ten_minutes_fit_into_memory(exact: WholeClipResult) -> None:
    longer = np.concatenate([np.arange(FRAMES), np.arange(FRAMES)[::-1]])
    result = solve(prior_from(TRUTH[np.array(POSED)])[longer], film(TRUTH[longer], 0.3))
    a_frame = (kept_bytes(result) - kept_bytes(exact)) / FRAMES
    assert 4 * BODY.skeleton.dof_count**2 < a_frame < 8_000


def test_exact_keyframes_are_recognized_and_kept(exact: WholeClipResult) -> None:
    assert exact.evidence.posing_scale < 0.3
    kept = point_error_m(exact.posture[np.array(POSED)], TRUTH[np.array(POSED)])
    assert kept.mean() < 0.004


def test_uncertainty_is_symmetric_positive_and_largest_far_from_keyframes(exact: WholeClipResult) -> None:
    covariance = exact.covariance
    np.testing.assert_allclose(covariance, np.swapaxes(covariance, -1, -2), atol=1e-12)
    assert np.linalg.eigvalsh(covariance).min() > 0.0
    spread = np.trace(covariance, axis1=-2, axis2=-1)
    middles = [(a + b) // 2 for a, b in zip(POSED, POSED[1:], strict=False)]
    assert spread[middles].mean() > 1.5 * spread[list(POSED)].mean()


@pytest.mark.parametrize("seed", [1, 2])
def test_carelessly_posed_keyframes_are_recognized_and_corrected(seed: int) -> None:
    posed = posed_by_hand(seed)
    prior = prior_from(posed)
    result = solve(prior, film(TRUTH, 0.3, seed))
    assert 0.4 < result.evidence.posing_scale < 2.0
    assert point_error_m(result.posture, TRUTH).mean() < 0.75 * point_error_m(prior, TRUTH).mean()
    at_keyframes = point_error_m(result.posture[np.array(POSED)], TRUTH[np.array(POSED)]).mean()
    assert at_keyframes < 0.9 * point_error_m(posed, TRUTH[np.array(POSED)]).mean()


def test_a_hidden_marker_costs_little(exact: WholeClipResult) -> None:
    tracks = film(TRUTH, 0.3)
    centroid = tracks.centroid.copy()
    centroid[20:26, 1] = np.nan
    quality = tracks.quality.copy()
    quality[20:26, 1] = 0.0
    result = solve(prior_from(TRUTH[np.array(POSED)]), replace(tracks, centroid=centroid, quality=quality))
    assert point_error_m(result.posture, TRUTH).mean() < point_error_m(exact.posture, TRUTH).mean() + 0.004


def test_one_frame_of_a_region_far_off_is_not_believed(exact: WholeClipResult) -> None:
    tracks = film(TRUTH, 0.3)
    centroid = tracks.centroid.copy()
    centroid[22, 3] += 60.0
    result = solve(prior_from(TRUTH[np.array(POSED)]), replace(tracks, centroid=centroid))
    moved = np.linalg.norm(
        BODY.points(BODY.pose(result.posture)) - BODY.points(BODY.pose(exact.posture)), axis=-1
    )
    assert moved.max() < 0.03


def test_a_correction_in_the_picture_holds_there_and_leaves_the_depth_to_the_rest() -> None:
    found = prior_from(TRUTH[np.array(POSED)].plus(np.tile(0.05 * TURNS, (len(POSED), 1))))
    scale, middle = np.ones(len(POSED)), np.arange(len(POSED)) == 3
    nearer = TRUTH[POSED[3]]
    away = 0.3 * CAMERA.sight(nearer.translation, np.array(0))
    nearer = Posture(nearer.skeleton, nearer.translation - away, nearer.rotations, nearer.angles)
    keyframes = [Keyframe(index, found[index]) for index in POSED]
    keyframes[3] = Keyframe(POSED[3], nearer)
    prior = interpolate(tuple(keyframes), FRAMES)
    motions = [
        run(estimate_whole_clip(BODY, CAMERA, Seen(film(TRUTH, 0.3), SEGMENTS), believed)).posture
        for believed in (
            belief_in(prior, POSED, np.where(middle, 0.0, scale)),
            belief_in(prior, POSED, scale, pictured=middle),
        )
    ]
    off = [BODY.points(BODY.pose(motion[POSED[3]])) - BODY.points(BODY.pose(nearer)) for motion in motions]
    sight = CAMERA.sight(BODY.points(BODY.pose(nearer)), np.array(0))
    along = [float(np.abs((each * sight).sum(-1)).mean()) for each in off]
    assert along[0] < 0.05 < along[1]  # posed, it stays; corrected in the picture, the rest tells
    seen = [CAMERA.project(BODY.points(BODY.pose(posture)))[0] for posture in (motions[1][POSED[3]], nearer)]
    assert np.linalg.norm(seen[0] - seen[1], axis=-1).mean() < 3.0


def test_footage_without_any_marker_gives_the_prior_back() -> None:
    tracks = film(TRUTH)
    empty = replace(
        tracks,
        centroid=np.full_like(tracks.centroid, np.nan),
        second_moment=np.full_like(tracks.second_moment, np.nan),
        area=np.full_like(tracks.area, np.nan),
        quality=np.zeros_like(tracks.quality),
    )
    prior = prior_from(TRUTH[np.array(POSED)])
    result = solve(prior, empty)
    assert point_error_m(result.posture, prior).mean() < 0.025
    assert np.isnan(result.residual_px).all()
