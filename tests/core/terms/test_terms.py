"""The terms of the whole-clip estimate: gradients against differences of their cost, and what they mean."""

from dataclasses import replace

import numpy as np
import pytest
from _scene import BODY, CAMERA, MODEL, exercise, film
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.prior.frame_prior import process_noise_factor
from keymark.core.terms.contact import FloorTerm, GroundTerm, StillnessTerm
from keymark.core.terms.depths import DepthTerm, point_depths
from keymark.core.terms.motion import BeliefTerm, LimitTerm, SmoothnessTerm
from keymark.core.terms.regions import (
    FEATURES,
    ObservedRegions,
    RegionNoise,
    RegionTerm,
    feature_rows,
    missing_variance,
)
from keymark.core.terms.state import ClipState
from keymark.core.terms.term import NormalEquations, QuadraticBuilder, Term, total_cost

FRAMES = 6
DOFS = HUMAN.dof_count


def state(seed: int = 1, size: float = 0.05) -> ClipState:
    """A prior and a seeded deviation from it."""
    rng = np.random.default_rng(seed)
    return ClipState(
        BODY,
        exercise(FRAMES),
        np.arange(FRAMES),
        process_noise_factor(exercise(FRAMES), np.arange(FRAMES) / 4.0),
        20.0 * size * rng.normal(size=(FRAMES, DOFS)),
        np.zeros((FRAMES, 0)),
    )


def moved(at: ClipState, step: np.ndarray) -> ClipState:
    """The state a small step away."""
    return at.stepped(step, np.inf)[0]


def gradient(term: Term, at: ClipState) -> np.ndarray:
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
        numeric = (cost(moved(at, step * direction)) - cost(moved(at, -step * direction))) / (2 * step)
        assert np.sum(ours * direction) == pytest.approx(numeric, rel=1e-4, abs=1e-6)


def test_the_ground_term_pulls_the_lower_ankle_to_its_height() -> None:
    term = GroundTerm((11, 12), 0.12)
    assert_gradient(term, lambda at: term.cost(at).sum(), state(size=0.02))
    lifted = [float(GroundTerm((11, 12), height).cost(state(size=0.0)).sum()) for height in (0.1, -0.5, -1.0)]
    assert lifted[0] < lifted[1] < lifted[2] < 1.4 * lifted[1]


def test_the_floor_pushes_up_what_is_below_it_and_nothing_else() -> None:
    at = state(size=0.0)
    ankles = BODY.points(at.pose)[:, [11, 12], 2]
    between = FloorTerm((11, 12), float(ankles.mean()))
    assert_gradient(between, lambda s: between.cost(s).sum(), at)
    assert between.cost(at).max() > 0.0
    assert np.abs(gradient(FloorTerm((11, 12), float(ankles.min()) - 0.001), at)).max() == 0.0


def test_a_foot_that_is_known_to_rest_is_held_however_fast_it_moves() -> None:
    at, step_s = state(size=0.5), np.full(FRAMES - 1, 1.0 / 30.0)
    free = StillnessTerm(CAMERA, (11, 12), step_s)
    known = replace(free, rests=np.ones((FRAMES - 1, 2)))
    assert free.resting(at).max() < 0.5
    assert np.abs(gradient(known, at)).max() > 10.0 * np.abs(gradient(free, at)).max()


def test_a_foot_rests_wherever_it_stays_in_place_the_higher_one_too() -> None:
    at = state(size=0.0)
    bent = np.array([name.startswith("knee.R") for name in BODY.skeleton.dof_names], dtype=float)
    still = replace(at, prior=at.prior[np.zeros(FRAMES, dtype=np.intp)].plus(np.tile(bent, (FRAMES, 1))))
    heights = BODY.points(still.pose)[0, [11, 12], 2]
    term = StillnessTerm(CAMERA, (11, 12), np.full(FRAMES - 1, 1.0 / 30.0))
    assert np.ptp(heights) > 2.0 * term.release_height_m
    np.testing.assert_allclose(term.resting(still), 1.0)


def test_the_depth_term_pulls_towards_the_priors_depths() -> None:
    at = state()
    frame = np.arange(FRAMES)
    prior = point_depths(BODY, CAMERA, BODY.pose(at.prior), frame)
    term = DepthTerm(CAMERA, prior)

    def cost(s: ClipState) -> float:
        depth = point_depths(BODY, CAMERA, s.pose, frame)
        return float(0.5 * np.sum((depth - prior) ** 2) / term.std_m**2)

    assert_gradient(term, cost, at)
    assert np.abs(gradient(term, moved(at, -at.unknowns))).max() < 1e-9


def test_the_limit_term_is_silent_within_the_range_and_pushes_back_past_it() -> None:
    at = state(size=0.0)
    assert np.abs(gradient(LimitTerm(), at)).max() == 0.0
    knee = HUMAN.dof_names.index("knee.R.flexion")
    deviation = np.zeros((FRAMES, DOFS))
    deviation[2, knee] = -0.5
    push = gradient(LimitTerm(), replace(at, factor=np.eye(DOFS), variation=deviation))
    assert push[2, knee] < 0.0
    assert np.count_nonzero(push) == 1


def test_terms_with_a_cost_descend_it_alone_and_together() -> None:
    at = state(seed=5, size=0.2)
    belief = BeliefTerm.of(FRAMES, DOFS, np.ones((1, 0)))
    ground = GroundTerm((11, 12), 0.12)
    for term in (belief, LimitTerm()):
        assert_gradient(term, lambda s, term=term: term.cost(s).sum(), at)
    parts = np.sum([term.cost(at) for term in (belief, LimitTerm(), ground)], axis=0)
    np.testing.assert_allclose(total_cost([ground, LimitTerm(), belief], at), parts, rtol=1e-12)
    assert LimitTerm().cost(at).max() > 0.0


def test_terms_of_a_clip_descend_their_cost() -> None:
    at = state(seed=7, size=0.02)
    prior = point_depths(BODY, CAMERA, BODY.pose(at.prior), at.frame)
    builder = QuadraticBuilder(FRAMES, DOFS)
    builder.add(slice(0, DOFS), (-0.9, 1.0), 0.3)
    for term in (DepthTerm(CAMERA, prior, np.full((FRAMES, 1), 0.2)), builder.term()):
        assert_gradient(term, lambda s, term=term: term.cost(s).sum(), at)
        assert term.cost(at).shape == (FRAMES,) and term.cost(at).sum() > 0.0
    smooth = SmoothnessTerm(0.8)
    assert_gradient(smooth, lambda s: smooth.cost(s).sum(), at)
    burst = replace(at, variation=30.0 * at.variation)
    assert smooth.cost(burst).sum() < 100.0 * smooth.cost(at).sum()  # 900 times as much if it were quadratic


def test_the_cost_of_a_moving_foot_grows_with_its_way_and_is_bounded() -> None:
    term = StillnessTerm(CAMERA, (HUMAN.point_names.index("ankle.L"),), np.full(FRAMES - 1, 1.0 / 30.0))
    across = CAMERA.matrix_world[:3, 0]
    held = exercise(1)[np.zeros(FRAMES, dtype=np.intp)]

    def cost(step_m: float) -> float:
        deviation = np.zeros((FRAMES, DOFS))
        deviation[:, :3] = step_m * across * np.arange(FRAMES)[:, None]
        at = ClipState(BODY, held, np.arange(FRAMES), np.eye(DOFS), deviation, np.zeros((FRAMES, 0)))
        found = term.cost(at)
        assert found[0] == 0.0  # of the later frame of each pair
        return float(found[1:].mean())

    assert cost(0.0003) == pytest.approx(0.5 * 0.1**2, rel=0.02)
    assert cost(0.001) < cost(0.02) < cost(0.06) < 1.05 * cost(0.02)


def pull(points: tuple[int, ...], step_m: np.ndarray) -> np.ndarray:
    """The stillness term's pull on the first frame of a body that moves as a whole (3,) [m a frame]."""
    term = StillnessTerm(CAMERA, points, np.full(FRAMES - 1, 1.0 / 30.0))
    deviation = np.zeros((FRAMES, DOFS))
    deviation[:, :3] = step_m * np.arange(FRAMES)[:, None]
    held = exercise(1)[np.zeros(FRAMES, dtype=np.intp)]
    at = ClipState(BODY, held, np.arange(FRAMES), np.eye(DOFS), deviation, np.zeros((FRAMES, 0)))
    return gradient(term, at)[0]


def test_the_stillness_term_holds_a_slow_foot_and_lets_a_fast_one_go() -> None:
    ankle = HUMAN.point_names.index("ankle.L")
    across = CAMERA.matrix_world[:3, 0]
    creeping, walking = (np.linalg.norm(pull((ankle,), across * v / 30.0)[:3]) for v in (0.06, 1.2))
    assert creeping > 0.0
    assert walking < 0.2 * creeping


def test_motion_along_the_line_of_sight_alone_does_not_free_a_foot() -> None:
    ankle = HUMAN.point_names.index("ankle.L")
    along, across = (
        np.linalg.norm(pull((ankle,), CAMERA.matrix_world[:3, axis] * 0.4 / 30.0)[:3]) for axis in (2, 0)
    )
    assert along > 5.0 * across


def test_a_raised_foot_is_not_held_while_the_other_stands_lower() -> None:
    posture = exercise(1)
    thigh = HUMAN.dof_names.index("hip.L.rotation_x")
    raised = np.zeros((FRAMES, DOFS))
    raised[:, thigh] = -1.2
    term = StillnessTerm(
        CAMERA,
        (HUMAN.point_names.index("ankle.L"), HUMAN.point_names.index("ankle.R")),
        np.full(FRAMES - 1, 1.0 / 30.0),
    )
    held = posture[np.zeros(FRAMES, dtype=np.intp)]
    raised[:, 0] = 0.001 * np.arange(FRAMES)
    at = ClipState(BODY, held, np.arange(FRAMES), np.eye(DOFS), raised, np.zeros((FRAMES, 0)))
    found = gradient(term, at)[0]
    left, right = (HUMAN.dof_names.index(f"hip.{side}.rotation_y") for side in "LR")
    assert abs(found[left]) < 0.05 * abs(found[right])


def test_bursts_of_acceleration_pull_less_than_their_size() -> None:
    at = state(size=0.0)
    limb = HUMAN.limbs[1]

    def push(size: float) -> float:
        variation = np.zeros((FRAMES, DOFS))
        variation[3, limb[0]] = size
        return float(np.abs(gradient(SmoothnessTerm(1.0), replace(at, variation=variation))).max())

    assert push(0.02) == pytest.approx(2.0 * push(0.01), rel=1e-2)
    assert push(20.0) < push(2.0)


def test_a_burst_in_one_limb_does_not_loosen_another() -> None:
    at = state(size=0.0)
    calm = np.zeros((FRAMES, DOFS))
    calm[2, HUMAN.limbs[2][0]] = 1.0
    kicking = calm.copy()
    kicking[2, HUMAN.limbs[4][0]] = 50.0
    limb = HUMAN.limbs[2]
    term = SmoothnessTerm(1.0)
    np.testing.assert_array_equal(
        gradient(term, replace(at, variation=calm))[:, limb],
        gradient(term, replace(at, variation=kicking))[:, limb],
    )


def test_features_of_a_region_against_itself_are_zero_and_grow_with_its_shift() -> None:
    posture = exercise(FRAMES)
    tracks = film(posture)
    predicted = MODEL.evaluate(BODY.pose(posture), np.arange(FRAMES))
    observed = ObservedRegions.from_tracks(tracks)
    residual, _ = feature_rows(observed, predicted)
    seen = tracks.visible
    assert residual.shape[-1] == FEATURES
    assert np.abs(residual[seen]).max() < 1e-9
    elsewhere = replace(observed, centroid=observed.centroid - [3.0, 0.0])
    shifted, _ = feature_rows(elsewhere, predicted)
    np.testing.assert_allclose(shifted[seen][:, 0], 3.0)
    np.testing.assert_allclose(shifted[seen][:, 1:], 0.0, atol=1e-9)


def test_a_shape_residual_is_the_difference_of_deviations_in_pixels() -> None:
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


def test_what_is_missing_of_a_region_widens_its_features() -> None:
    predicted = MODEL.evaluate(BODY.pose(exercise(1)), np.arange(1))
    variance = [missing_variance(share * predicted.area, 1.0, predicted) for share in (1.0, 0.5, 0.25)]
    assert variance[0].max() == 0.0
    along = np.sqrt(predicted.second_moment[..., 0, 0])
    assert np.all(np.sqrt(variance[1][..., 0]) > 0.4 * along)
    assert np.all(variance[2] > variance[1])


def test_a_body_behind_the_camera_is_not_compared_with_regions() -> None:
    tracks = film(exercise(FRAMES))
    behind = Posture.stack([exercise(FRAMES)[index] for index in range(FRAMES)])
    location = CAMERA.pose()[1]
    away = behind.translation + 2.0 * (location - behind.translation)
    at = replace(state(size=0.0), prior=Posture(HUMAN, away, behind.rotations, behind.angles))
    observed, count = ObservedRegions.from_tracks(tracks), len(MODEL.placements)
    widths = np.full((FRAMES, count), 20.0)
    term = RegionTerm(MODEL, observed, RegionNoise(), widths, np.ones(count), np.ones(count))
    at = replace(at, bias=np.zeros((FRAMES, count * FEATURES)))
    equations = NormalEquations(FRAMES, DOFS + count * FEATURES)
    term.add_to(equations, at, 1.0)
    assert np.isfinite(equations.gradient).all() and np.isfinite(term.cost(at)).all()
    assert not equations.gradient.any()


def test_information_of_regions_falls_with_temperature_noise_and_doubt() -> None:
    at, tracks = state(size=0.0), film(exercise(FRAMES))
    observed, ones = ObservedRegions.from_tracks(tracks), np.ones(len(MODEL.placements))
    term = RegionTerm(MODEL, observed, RegionNoise(), np.full((FRAMES, len(ones)), 20.0), ones, ones)
    predicted = MODEL.evaluate(at.pose, at.frame)
    nothing = np.zeros((FRAMES, len(ones), FEATURES))
    cool, warm = (term.weights(nothing, predicted, temperature) for temperature in (1.0, 4.0))
    assert (cool > 0.0).any()
    np.testing.assert_allclose(warm, cool / 4.0)
    doubted = replace(term, distrust=2.0 * ones).weights(nothing, predicted, 1.0)
    assert (doubted[cool > 0.0] < cool[cool > 0.0]).all() and (doubted >= cool / 4.0 - 1e-12).all()
