"""Postures: the contract of `plus` and `minus`, mirrored, splined, and fitted to points."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from _libraries import random_posture
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.body import rotations
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import sole_places
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.mirror import MIRROR, mirrored, other_side
from keymark.core.body.posture import Posture
from keymark.core.body.posture_fit import fit_posture
from keymark.core.body.posture_spline import cubic_spline
from scipy.interpolate import CubicHermiteSpline


def away_from_rest(seed: int, batch: tuple[int, ...] = (), spread: float = 0.8) -> Posture:
    """Postures away from rest in every degree of freedom."""
    return Posture.rest(HUMAN, batch).plus(np.random.default_rng(seed).normal(0.0, spread, (*batch, 34)))


def assert_same(first: Posture, second: Posture, tolerance: float = 1e-12) -> None:
    np.testing.assert_allclose(first.translation, second.translation, atol=tolerance)
    np.testing.assert_allclose(first.rotations, second.rotations, atol=tolerance)
    np.testing.assert_allclose(first.angles, second.angles, atol=tolerance)


@pytest.mark.parametrize("size", [0.0, 1e-12, 1e-8, 1e-3, 0.5, 1.5, np.pi - 1e-6])
@pytest.mark.parametrize("seed", range(3))
def test_minus_finds_the_step_that_plus_took(size: float, seed: int) -> None:
    start, rng = away_from_rest(seed), np.random.default_rng(seed + 100)
    step = rng.normal(size=34)
    turns = step[HUMAN.ball_dofs]
    step[HUMAN.ball_dofs] = turns / np.linalg.norm(turns, axis=-1, keepdims=True)
    np.testing.assert_allclose(start.plus(size * step).minus(start), size * step, atol=2e-9)


def test_turns_are_taken_in_the_childs_frame() -> None:
    start, turn = away_from_rest(2), np.array([0.1, -0.4, 0.2])
    step = np.zeros(34)
    step[HUMAN.ball_dofs[3]] = turn
    expected = start.rotations[3] @ rotations.exponential(turn)
    np.testing.assert_allclose(start.plus(step).rotations[3], expected, atol=1e-14)


@given(st.integers(0, 2**32 - 1))
def test_vectors_hold_the_whole_posture(seed: int) -> None:
    posture = away_from_rest(seed, spread=1.5)
    vector = posture.to_vector()
    assert np.linalg.norm(vector[HUMAN.ball_dofs], axis=-1).max() <= np.pi + 1e-12
    assert_same(Posture.from_vector(HUMAN, vector), posture, 1e-7)


@pytest.mark.parametrize("size", [0.0, 1e-8, 0.3, 2.0])
@pytest.mark.parametrize("seed", range(5))
def test_plus_jacobian_agrees_with_central_differences(size: float, seed: int) -> None:
    start, rng = away_from_rest(seed), np.random.default_rng(seed)
    delta, step = size * rng.normal(0.0, 0.5, 34), 1e-6
    result = start.plus(delta)
    numeric = start.plus(delta + step * np.eye(34)).minus(result) - start.plus(
        delta - step * np.eye(34)
    ).minus(result)
    np.testing.assert_allclose(start.plus_jacobian(delta), numeric.T / (2.0 * step), atol=1e-8)


def test_batches_broadcast_and_index() -> None:
    start, steps = away_from_rest(4), np.random.default_rng(5).normal(0.0, 0.3, (6, 34))
    many = start.plus(steps)
    assert many.batch == (6,)
    assert_same(many[2], start.plus(steps[2]))
    assert many[1:4].batch == (3,)
    assert_same(Posture.stack([many[i] for i in range(6)]), many, 0.0)
    np.testing.assert_allclose(many.minus(start), steps, atol=1e-12)


def test_a_posture_cannot_be_changed_behind_its_back() -> None:
    given_place = np.zeros(3)
    posture = Posture(HUMAN, given_place, Posture.rest(HUMAN).rotations, Posture.rest(HUMAN).angles)
    given_place[0] = 5.0
    assert posture.translation[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        posture.angles[0] = 1.0


@given(st.integers(0, 2**32 - 1))
def test_mirroring_twice_gives_the_very_same_numbers(seed: int) -> None:
    posture = Posture.stack([random_posture(seed, 1.2), random_posture(seed + 1)])
    twice = mirrored(mirrored(posture))
    np.testing.assert_array_equal(twice.translation, posture.translation)
    np.testing.assert_array_equal(twice.rotations, posture.rotations)
    np.testing.assert_array_equal(twice.angles, posture.angles)
    assert np.abs(mirrored(posture).to_vector() - posture.to_vector()).max() > 0.1


@pytest.mark.parametrize("seed", range(5))
def test_points_are_mirrored(seed: int) -> None:
    lengths = dict(Actor.from_stature(1.75).segments_m) | {"thigh.L": 0.5, "upper_arm.R": 0.25}
    swapped_lengths = {name: lengths[other_side(name)] for name in lengths}
    body, opposite = Body(Actor(lengths)), Body(Actor(swapped_lengths))
    posture = random_posture(seed, 0.8)
    pose, mirror_pose = body.pose(posture), opposite.pose(mirrored(posture))
    names = HUMAN.point_names
    swapped = [names.index(other_side(name)) for name in names]
    np.testing.assert_allclose(opposite.points(mirror_pose), body.points(pose)[swapped] * MIRROR, atol=1e-12)
    soles = sole_places(body, pose)[::-1] * MIRROR
    np.testing.assert_allclose(sole_places(opposite, mirror_pose), soles, atol=1e-12)
    for name in ("hand.L", "foot.R"):
        ends, others = opposite.segment_ends(mirror_pose, name), body.segment_ends(pose, other_side(name))
        np.testing.assert_allclose(np.stack(ends), np.stack(others) * MIRROR, atol=1e-12)


KNOTS = np.array([0.0, 2.0, 3.0, 7.0, 8.0])
VALUES = np.array([0.1, 0.5, 1.4, 1.6, 0.2])
KNEE = HUMAN.dof_names.index("knee.L.flexion")
TIMES = np.linspace(-1.0, 9.0, 101)


def posed() -> Posture:
    vector = np.zeros((len(KNOTS), 34))
    vector[:, KNEE] = VALUES
    return Posture.from_vector(HUMAN, vector)


def test_a_hinge_follows_the_limited_cubic() -> None:
    slope, gap = np.diff(VALUES) / np.diff(KNOTS), np.diff(KNOTS)
    inner = (gap[1:] * slope[:-1] + gap[:-1] * slope[1:]) / (gap[1:] + gap[:-1])
    limit = 3.0 * np.minimum(abs(slope[:-1]), abs(slope[1:]))
    inner = np.where(slope[:-1] * slope[1:] > 0.0, np.clip(inner, -limit, limit), 0.0)
    assert inner[1] == pytest.approx(3.0 * slope[2]) and inner[2] == 0.0  # both limits are at work
    expected = CubicHermiteSpline(KNOTS, VALUES, np.concatenate([slope[:1], inner, slope[-1:]]))
    found = cubic_spline(posed(), KNOTS, TIMES).to_vector()
    np.testing.assert_allclose(found[:, KNEE], expected(np.clip(TIMES, 0.0, 8.0)), atol=1e-12)
    assert not np.delete(found, KNEE, axis=1).any()


def test_balls_pass_their_postures_smoothly() -> None:
    turned = Posture.rest(HUMAN, (5,)).plus(np.random.default_rng(2).normal(0.0, 0.5, (5, 34)))
    at = cubic_spline(turned, KNOTS, KNOTS)
    np.testing.assert_allclose(at.minus(turned), 0.0, atol=1e-9)
    step = 1e-5
    before, here, after = (cubic_spline(turned, KNOTS, KNOTS[1:-1] + s) for s in (-step, 0.0, step))
    np.testing.assert_allclose(here.minus(before) / step, after.minus(here) / step, atol=1e-3)


BODY = Body(Actor.from_stature(1.75))


def plausible_postures(count: int, seed: int) -> Posture:
    """Postures anywhere in the world, every way round, with joints within most of their range."""
    rng = np.random.default_rng(seed)
    lower, upper = (np.where(np.isfinite(bound), bound, 0.0) for bound in HUMAN.limits.T)
    vector = lower + (upper - lower) * rng.uniform(0.25, 0.75, (count, 34))
    vector[:, :3] = rng.normal(0.0, 3.0, (count, 3))
    vector[:, 3:6] = rng.normal(0.0, 1.0, (count, 3)) * [0.4, 0.4, 2.0]
    return Posture.from_vector(HUMAN, vector)


def points_of(posture: Posture, body: Body = BODY) -> np.ndarray:
    return body.points(body.pose(posture))


def test_noise_free_points_are_met_to_a_tenth_of_a_millimeter() -> None:
    targets = points_of(plausible_postures(60, 0))
    fit = fit_posture(BODY, targets)
    np.testing.assert_allclose(fit.residual_m, np.linalg.norm(points_of(fit.posture) - targets, axis=-1))
    assert np.median(fit.residual_m) < 1e-4
    worst = fit.residual_m.max(axis=-1)
    assert np.mean(worst < 2e-3) >= 0.9
    assert worst.max() < 0.02


@pytest.mark.parametrize("side", ["L", "R"])
@pytest.mark.parametrize("joint", ["elbow", "knee"])
def test_hinges_bend_the_way_joints_do(joint: str, side: str) -> None:
    vector = np.zeros((1, 34))
    vector[0, HUMAN.dof_names.index(f"{joint}.{side}.flexion")] = 1.2
    fit = fit_posture(BODY, points_of(Posture.from_vector(HUMAN, vector)))
    assert fit.posture.to_vector()[0, HUMAN.dof_names.index(f"{joint}.{side}.flexion")] == pytest.approx(
        1.2, abs=0.02
    )


def test_a_start_far_away_does_not_diverge() -> None:
    truth = plausible_postures(20, 1)
    targets = points_of(truth)
    rng = np.random.default_rng(2)
    step = rng.normal(0.0, 0.6, (20, 34))
    step[:, :3] = rng.normal(0.0, 2.0, (20, 3))
    start = truth.plus(step)
    fit = fit_posture(BODY, targets, start)
    before = np.linalg.norm(points_of(start) - targets, axis=-1).mean(axis=-1)
    after = fit.residual_m.mean(axis=-1)
    assert (after <= before).all()
    assert np.median(after) < 1e-3


def test_noisy_points_are_met_within_their_noise() -> None:
    rng = np.random.default_rng(3)
    truth = points_of(plausible_postures(30, 4))
    fit = fit_posture(BODY, truth + rng.normal(0.0, 0.025 / 3.0**0.5, truth.shape))
    error = np.linalg.norm(points_of(fit.posture) - truth, axis=-1)
    assert np.sqrt(np.mean(error**2)) < 0.025
    assert fit.residual_m.max() < 0.08


def test_unknown_points_are_left_out() -> None:
    truth = plausible_postures(5, 5)
    targets = points_of(truth)
    hidden = [HUMAN.point_names.index(name) for name in ("wrist.L", "ankle.R")]
    targets[:, hidden] = np.nan
    start = truth.plus(np.random.default_rng(6).normal(0.0, 0.15, (5, 34)))
    fit = fit_posture(BODY, targets, start)
    seen = np.setdiff1d(np.arange(13), hidden)
    assert np.isnan(fit.residual_m[:, hidden]).all()
    assert fit.residual_m[:, seen].max() < 1e-3
    assert np.isfinite(fit.posture.to_vector()).all()


def test_points_no_body_can_reach_still_give_a_finite_posture() -> None:
    tall = Body(Actor.from_stature(2.0))
    fit = fit_posture(BODY, points_of(plausible_postures(10, 7), tall))
    assert fit.residual_m.mean() < 0.08
    heap = fit_posture(BODY, np.zeros((1, 13, 3)))
    assert np.isfinite(heap.posture.to_vector()).all()
    assert np.isfinite(heap.residual_m).all()


@pytest.mark.parametrize("name", ["walk", "reach", "aerobic", "real_balance"])
def test_keyframes_of_real_takes_are_fitted(take_folder: Callable[[str], Path], name: str) -> None:
    folder = take_folder(name)
    actor = Actor(json.loads((folder / "take.json").read_text())["actor"]["segments_m"])
    keyframes = json.loads((folder / "keyframes.json").read_text())["keyframes"]
    targets = np.array([[keyframe["points"][point] for point in HUMAN.point_names] for keyframe in keyframes])
    fit = fit_posture(Body(actor), targets)
    assert fit.residual_m.mean() < 0.012
    assert fit.residual_m.max() < 0.08
