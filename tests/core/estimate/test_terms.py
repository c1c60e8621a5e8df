"""The terms of the whole-clip estimate: gradients against differences of their cost, and what they mean."""

from dataclasses import replace

import numpy as np
import pytest
from _scene import BODY, CAMERA, MODEL, exercise, film
from keymark.core.body.human import HUMAN
from keymark.core.estimate.clip_state import ClipState
from keymark.core.estimate.terms.depths import DepthTerm
from keymark.core.estimate.terms.limits import LimitTerm
from keymark.core.estimate.terms.quadratic import QuadraticBuilder
from keymark.core.estimate.terms.regions import FEATURES, ObservedRegions, feature_rows
from keymark.core.estimate.terms.stillness import StillnessTerm
from keymark.core.estimate.terms.term import NormalEquations, Term, student_weight
from keymark.core.observation import depths

FRAMES = 6
DOFS = HUMAN.dof_count


def state(seed: int = 1, size: float = 0.05) -> ClipState:
    """A prior and a seeded deviation from it."""
    rng = np.random.default_rng(seed)
    return ClipState(
        BODY,
        exercise(FRAMES),
        np.arange(FRAMES),
        size * rng.normal(size=(FRAMES, DOFS)),
        np.zeros((FRAMES, 0)),
    )


def gradient(term: Term, at: ClipState) -> np.ndarray:
    """The gradient a term adds."""
    equations = NormalEquations(FRAMES, DOFS)
    term.add_to(equations, at, 1.0)
    return equations.gradient


def assert_gradient(term: Term, cost, at: ClipState) -> None:  # noqa: ANN001
    """A term's gradient equals central differences of its cost in random directions."""
    rng = np.random.default_rng(3)
    ours = gradient(term, at)
    for _ in range(6):
        direction = rng.normal(size=ours.shape)
        step = 1e-6
        numeric = (cost(at.stepped(step * direction)) - cost(at.stepped(-step * direction))) / (2 * step)
        assert np.sum(ours * direction) == pytest.approx(numeric, rel=1e-4, abs=1e-6)


def test_the_depth_term_pulls_towards_the_priors_depths() -> None:
    """½ Σ ((d - d_p) / σ)²."""
    at = state()
    frame = np.arange(FRAMES)
    prior = depths.evaluate(BODY, CAMERA, BODY.pose(at.prior), frame)
    term = DepthTerm(CAMERA, prior)

    def cost(s: ClipState) -> float:
        depth = depths.evaluate(BODY, CAMERA, s.pose, frame)
        return float(0.5 * np.sum((depth - prior) ** 2) / term.std_m**2)

    assert_gradient(term, cost, at)
    assert np.abs(gradient(term, at.stepped(-at.unknowns))).max() < 1e-9


def test_the_limit_term_is_silent_within_the_range_and_pushes_back_past_it() -> None:
    """A knee bent backwards is pushed forwards, one bent as knees bend is not touched."""
    at = state(size=0.0)
    assert np.abs(gradient(LimitTerm(), at)).max() == 0.0
    knee = HUMAN.dof_names.index("knee.R.flexion")
    deviation = np.zeros((FRAMES, DOFS))
    deviation[2, knee] = -0.5
    push = gradient(LimitTerm(), ClipState(BODY, at.prior, at.frame, deviation, at.bias))
    assert push[2, knee] < 0.0
    assert np.count_nonzero(push) == 1


def test_the_stillness_term_holds_a_slow_foot_and_lets_a_fast_one_go() -> None:
    """The pull on a foot at walking speed is a small part of that on one that creeps."""
    ankle = HUMAN.point_names.index("ankle.L")
    term = StillnessTerm((ankle,), np.full(FRAMES - 1, 1.0 / 30.0))

    def pull(speed_m_s: float) -> float:
        deviation = np.zeros((FRAMES, DOFS))
        deviation[:, 0] = speed_m_s / 30.0 * np.arange(FRAMES)
        held = exercise(1)[np.zeros(FRAMES, dtype=np.intp)]
        return float(
            np.abs(
                gradient(term, ClipState(BODY, held, np.arange(FRAMES), deviation, np.zeros((FRAMES, 0))))[
                    0, 0
                ]
            )
        )

    assert pull(0.03) > 0.0
    assert pull(1.2) < 0.2 * pull(0.06)


def test_the_quadratic_term_is_the_sum_of_its_rows() -> None:
    """Second differences over a standard deviation, and its gradient."""
    builder = QuadraticBuilder(FRAMES, DOFS)
    std = np.linspace(0.1, 1.0, DOFS)
    builder.add(slice(0, DOFS), (1.0, -2.0, 1.0), std)
    at = state()

    def cost(s: ClipState) -> float:
        return float(0.5 * np.sum((np.diff(s.deviation, 2, axis=0) / std) ** 2))

    assert_gradient(builder.term(), cost, at)


def test_features_of_a_region_against_itself_are_zero_and_grow_with_its_shift() -> None:
    """Residuals are in pixels: a region three pixels off differs by three pixels and by no shape."""
    posture = exercise(FRAMES)
    tracks = film(posture)
    predicted = MODEL.evaluate(BODY.pose(posture), np.arange(FRAMES))
    observed = ObservedRegions.from_tracks(tracks)
    residual, _ = feature_rows(observed, predicted)
    seen = tracks.visible
    assert residual.shape[-1] == FEATURES
    assert np.abs(residual[seen]).max() < 1e-9
    moved = ObservedRegions(
        observed.centroid - [3.0, 0.0],
        observed.second_moment,
        observed.axes,
        observed.deviation,
        observed.quality,
    )
    shifted, _ = feature_rows(moved, predicted)
    np.testing.assert_allclose(shifted[seen][:, 0], 3.0)
    np.testing.assert_allclose(shifted[seen][:, 1:], 0.0, atol=1e-9)


def test_a_shape_residual_is_the_difference_of_deviations_in_pixels() -> None:
    """A region stretched by a tenth along its axis differs by about a tenth of its deviation there."""
    posture = exercise(1)
    predicted = MODEL.evaluate(BODY.pose(posture), np.arange(1))
    tracks = film(posture)
    observed = ObservedRegions.from_tracks(tracks)
    stretched = (
        observed.axes @ np.apply_along_axis(np.diag, -1, [1.0, 1.1]) @ np.swapaxes(observed.axes, -1, -2)
    )
    moment = stretched @ observed.second_moment @ np.swapaxes(stretched, -1, -2)
    wider = replace(tracks, second_moment=moment)
    residual, _ = feature_rows(ObservedRegions.from_tracks(wider), predicted)
    long_axis = observed.deviation[0, :, 1]
    np.testing.assert_allclose(residual[0, :, 4], -0.1 * long_axis, rtol=0.06)


def test_student_weights_fall_with_the_residual() -> None:
    """One at zero, half where the mean square equals the degrees of freedom."""
    weight = student_weight(np.array([0.0, 8.0, 800.0]), 4.0, 2)
    np.testing.assert_allclose(weight, [1.0, 0.5, 4.0 / 404.0])
