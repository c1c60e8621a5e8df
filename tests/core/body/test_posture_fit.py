"""Fitting postures to thirteen points."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.body.posture_fit import fit_posture

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
