"""The terms: slopes and gradient of any against differences of its errors and cost, and what they mean."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest
from _recorded import assert_recorded
from _scene import BODY, CAMERA, LAYOUT, MODEL, SEGMENTS, detect, exercise, film
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import exponential
from keymark.core.numerics.block_banded import BlockBanded
from keymark.core.prior.frame_prior import process_noise_factor
from keymark.core.terms.contact import BalanceTerm, FloorTerm, GroundTerm, StillnessTerm
from keymark.core.terms.contours import AxialTerm, ContourModel, ContourTerm, LimbAxes
from keymark.core.terms.depths import DepthHintTerm, DepthLinks, DepthTerm, point_depths
from keymark.core.terms.head import HeadTerm, ObservedHeads
from keymark.core.terms.keypoints import KeypointModel, KeypointTerm, ObservedKeypoints
from keymark.core.terms.motion import LimitTerm, SmoothnessTerm, belief_term
from keymark.core.terms.reference import ExpectedPoints, ReferenceTerm
from keymark.core.terms.regions import (
    FEATURES,
    ObservedRegions,
    RegionTerm,
)
from keymark.core.terms.solver import assembling, descend
from keymark.core.terms.term import ClipState, NormalEquations, QuadraticTerm, Rows, Term, total_cost

FRAMES = 6
DOFS = HUMAN.dof_count
STEP_S = np.full(FRAMES - 1, 1.0 / 30.0)
KEPT = np.full((FRAMES - 1, 1), 0.8)


def state(seed: int = 1, size: float = 0.05, biases: int = 0) -> ClipState:
    """A prior and a seeded deviation from it."""
    rng = np.random.default_rng(seed)
    return ClipState(
        BODY,
        exercise(FRAMES),
        np.arange(FRAMES),
        process_noise_factor(exercise(FRAMES), np.arange(FRAMES) / 4.0),
        20.0 * size * rng.normal(size=(FRAMES, DOFS)),
        rng.normal(size=(FRAMES, biases)),
    )


def gradient(term: Term, at: ClipState) -> np.ndarray:
    equations = NormalEquations(FRAMES, at.unknowns.shape[1])
    term.add_to(equations, at, 1.0)
    return equations.gradient


def assert_descends(term: Term, at: ClipState, share: float = 1e-4) -> None:
    """Slopes equal central differences of the errors, and the gradient those of the cost, to a share.

    An infinite share is of errors whose slopes leave out what costs nothing.
    """
    rng = np.random.default_rng(3)
    ours = gradient(term, at)
    assert np.abs(ours).max() > 0.0
    for _ in range(4):
        direction = rng.normal(size=ours.shape)
        there, back = (at.stepped(sign * 1e-6 * direction, np.inf)[0] for sign in (1.0, -1.0))
        numeric = (term.cost(there) - term.cost(back)).sum() / 2e-6
        if term.lasting is None:
            near = share if np.isfinite(share) else 1e-4
            size = near * np.abs(ours).sum()
            assert np.sum(ours * direction) == pytest.approx(numeric, rel=near, abs=size)
        if type(term).rows is Term.rows or np.isinf(share):
            continue
        moved = (term.rows(one, slopes=False) for one in (there, back))
        for rows, far, near in zip(term.rows(at), *moved, strict=True):
            tangent = (at.tangent_jacobian @ direction[:, :DOFS, None])[..., 0]
            assert rows.slopes is not None and far.slopes is None
            foretold = (rows.slopes @ tangent[:, None, :, None])[..., 0]
            if rows.bias is not None:
                slopes, index = rows.bias
                foretold = foretold + slopes * direction[:, DOFS + index]
            found = (far.error - near.error)[rows.used] / 2e-6
            typical = np.abs(found).max()
            np.testing.assert_allclose(foretold[rows.used], found, rtol=share, atol=share * typical)


def _heads(at: ClipState) -> ObservedHeads:
    """Heads turned by some tenths of a radian from a state's, and one that is not seen."""
    turn = at.pose.rotation[:, HUMAN.joint_index("neck")]
    apart = exponential(np.random.default_rng(6).normal(size=(FRAMES, 3)) * 0.3)
    return ObservedHeads(turn @ apart, np.where(np.arange(FRAMES) == 2, np.inf, 0.2))


def every_term() -> dict[str, tuple[Term, ClipState, float]]:
    """Each term, a state at which it pulls, and the share within which its slopes are right."""
    frame, rng, at = np.arange(FRAMES), np.random.default_rng(4), state(size=0.02)
    ankles = (11, 12)
    depth = point_depths(BODY, CAMERA, BODY.pose(at.prior), frame)
    model = KeypointModel.usual(BODY, CAMERA, LAYOUT)
    seen = detect(exercise(FRAMES), hint_error_m=0.03)
    points, links = ObservedKeypoints.of(seen), DepthLinks.between(LAYOUT, seen.sources)
    expected = links.guessed(points.depth_m)
    expected[2, 1] = np.nan
    std_m = np.where(np.arange(len(LAYOUT)) == 3, np.inf, 0.03)
    outlines = ContourModel.average(BODY, CAMERA)
    edges = outlines.evaluate(BODY.pose(at.prior), frame)
    axes = LimbAxes(outlines.parts, CAMERA)
    parts = len(outlines.parts.segments)
    direction = rng.normal(size=(FRAMES, parts, 2))
    shares = rng.uniform(size=(FRAMES, parts))
    place = np.sum(direction * axes.points(BODY.pose(at.prior), frame, shares)[1], axis=-1)
    about = BODY.points(BODY.pose(at.prior))
    about = about - about[:, [7, 8]].mean(axis=1, keepdims=True)
    bent = np.zeros((FRAMES, DOFS))
    bent[2, HUMAN.dof_names.index("knee.R.flexion")] = -0.5
    count = len(MODEL.placements)
    matrix = BlockBanded(FRAMES, DOFS)
    matrix.add_combination(slice(0, DOFS), (-0.9, 1.0), np.full(DOFS, 0.3**-2))
    ones = np.ones(count)
    observed, width_px = ObservedRegions.from_tracks(film(exercise(FRAMES))), np.full((FRAMES, count), 20.0)
    regions = RegionTerm(MODEL, observed, width_px, ones, ones)
    elsewhere = ExpectedPoints(about, np.full((FRAMES, 13, 3, 3), 20.0 * np.eye(3)), 0.4)
    return {
        "ground": (GroundTerm(ankles, 0.12), at, 1e-4),
        "floor": (FloorTerm(ankles, float(BODY.points(at.pose)[:, ankles, 2].mean())), at, 1e-4),
        "balance": (BalanceTerm(BODY), at, np.inf),
        "depths": (DepthTerm(CAMERA, depth, np.full(depth.shape, 0.2)), at, 1e-4),
        "limits": (LimitTerm(), replace(at, factor=np.eye(DOFS), variation=bent), 1e-4),
        "belief": (belief_term(FRAMES, DOFS, np.ones((1, 0))), at, 1e-4),
        "quadratic": (QuadraticTerm(matrix), at, 1e-4),
        "smoothness": (SmoothnessTerm(0.8), at, 1e-4),
        "keypoints": (KeypointTerm(model, points, std_m), at, 0.02),
        "keypoints that last": (KeypointTerm(model, points, std_m, KEPT), at, 0.02),
        "head": (HeadTerm(_heads(at), KEPT), at, 1e-4),
        "hints": (DepthHintTerm(model, links, expected, np.full(expected.shape, 0.1)), at, 1e-4),
        "contours": (ContourTerm(outlines, edges.pixel, edges.normal, np.ones(edges.depth.shape)), at, 0.1),
        "axes": (AxialTerm(axes, shares, place, direction, np.full(place.shape, 4.0), KEPT), at, 1e-3),
        "reference": (ReferenceTerm(elsewhere, KEPT), at, 1e-4),
        "regions": (regions, state(size=0.02, biases=count * FEATURES), 0.05),
    }


TERMS = every_term()


@pytest.mark.parametrize("name", TERMS)
def test_slopes_and_gradients_are_those_of_errors_and_cost(name: str) -> None:
    term, at, share = TERMS[name]
    assert_descends(term, at, share)
    assert_recorded(f"term {name}", term.cost(at), gradient(term, at))


def test_costs_add_up() -> None:
    at = state(seed=5, size=0.2)
    terms = [TERMS[name][0] for name in ("belief", "limits", "ground")]
    np.testing.assert_allclose(total_cost(terms, at), sum(term.cost(at) for term in terms), rtol=1e-12)
    found, least = descend(at, [*terms, TERMS["keypoints"][0]])
    assert_recorded("descent", found.variation, least)


def test_what_lies_within_bounds_is_left_alone() -> None:
    at = state(size=0.0)
    lowest = float(BODY.points(at.pose)[:, [11, 12], 2].min())
    depth = point_depths(BODY, CAMERA, at.pose, at.frame)
    silent = LimitTerm(), FloorTerm((11, 12), lowest - 0.001), DepthTerm(CAMERA, depth, np.ones(depth.shape))
    for term in silent:
        assert np.abs(gradient(term, at)).max() < 1e-9 and term.cost(at).max() < 1e-12


def test_a_hinge_past_its_range_is_pushed_back_alone() -> None:
    term, at, _ = TERMS["limits"]
    push = gradient(term, at)
    assert push[2, HUMAN.dof_names.index("knee.R.flexion")] < 0.0
    assert np.count_nonzero(push) == 1


def test_leaps_are_forgiven() -> None:
    lifted = [float(GroundTerm((11, 12), height).cost(state(size=0.0)).sum()) for height in (0.1, -0.5, -1.0)]
    assert lifted[0] < lifted[1] < lifted[2] < 1.4 * lifted[1]


@dataclass(frozen=True, eq=False)
class Numbers(Term):
    """Errors (F, 1, G) that are the unknowns themselves."""

    error: np.ndarray
    used: np.ndarray
    lasting: np.ndarray | None

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        by = np.broadcast_to(np.eye(self.error.shape[-1], DOFS), (*self.error.shape, DOFS))
        yield Rows(self.error, by if slopes else None, self.used)


def numbers(
    error: np.ndarray, kept: float, used: np.ndarray | None = None
) -> tuple[np.ndarray, NormalEquations]:
    """Cost and equations of errors that last."""
    frames = len(error)
    used = np.ones((frames, 1), dtype=bool) if used is None else used
    term = Numbers(error, used, np.full((frames - 1, 1), kept))
    still, nothing = exercise(1)[np.zeros(frames, dtype=np.intp)], np.zeros((frames, DOFS))
    at = ClipState(BODY, still, np.arange(frames), np.eye(DOFS), nothing, nothing[:, :0])
    equations = NormalEquations(frames, DOFS)
    term.add_to(equations, at, 1.0)
    return term.cost(at), equations


def test_errors_that_last_have_the_likelihood_of_a_first_order_process() -> None:
    error = 1e-4 * np.random.default_rng(1).normal(size=(7, 1, 1))
    _, equations = numbers(error, 0.8)
    apart = np.abs(np.subtract.outer(np.arange(7), np.arange(7)))
    information = np.linalg.inv(0.8**apart)
    beside = equations.matrix.next[:, 0, 0]
    found = np.diag(equations.matrix.diagonal[:, 0, 0]) + np.diag(beside, 1) + np.diag(beside, -1)
    np.testing.assert_allclose(found, information, atol=1e-6)
    np.testing.assert_allclose(equations.gradient[:, 0], information @ error[:, 0, 0], atol=1e-9)


def test_the_cost_of_errors_that_last_is_that_of_their_changes() -> None:
    steady = np.full((20, 1, 1), 0.5)
    calm, _ = numbers(steady, 0.95)
    wild, _ = numbers(steady * np.where(np.arange(20) % 2, 1.0, -1.0)[:, None, None], 0.95)
    assert calm[1:].max() < 0.2 * calm[0] and wild[1:].min() > 10.0 * calm[0]
    outlier = steady.copy()
    outlier[10] = 1000.0
    assert numbers(outlier, 0.95)[0].sum() < calm.sum() + 60.0
    assert numbers(steady, 0.95, np.zeros((20, 1), dtype=bool))[0].sum() == 0.0


def test_errors_begin_anew_after_a_gap_or_an_outlier() -> None:
    error, used = np.zeros((5, 1, 2)), np.ones((5, 1), dtype=bool)
    used[2] = False
    _, equations = numbers(error, 0.8, used)
    assert not equations.matrix.next[1:3].any() and equations.matrix.diagonal[3, 0, 0] > 1.0
    error[1] = 50.0
    assert np.abs(numbers(error, 0.8, used)[1].gradient).max() < 0.5


def test_a_foot_that_is_known_to_rest_is_held_however_fast_it_moves() -> None:
    at = state(size=0.5)
    free = StillnessTerm(CAMERA, (11, 12), STEP_S)
    known = replace(free, rests=np.ones((FRAMES - 1, 2)))
    assert free.resting(at).max() < 0.5
    for name, term, there in (
        ("free", free, state(size=0.01)),
        ("unsure", replace(known, rests=0.7 * known.rests), at),
    ):
        assert_recorded(f"stillness {name}", term.cost(there), gradient(term, there), term.resting(there))
    assert np.abs(gradient(known, at)).max() > 10.0 * np.abs(gradient(free, at)).max()


def test_a_foot_rests_wherever_it_stays_in_place_the_higher_one_too() -> None:
    at = state(size=0.0)
    bent = np.array([name.startswith("knee.R") for name in BODY.skeleton.dof_names], dtype=float)
    still = replace(at, prior=at.prior[np.zeros(FRAMES, dtype=np.intp)].plus(np.tile(bent, (FRAMES, 1))))
    heights = BODY.points(still.pose)[0, [11, 12], 2]
    term = StillnessTerm(CAMERA, (11, 12), STEP_S)
    assert np.ptp(heights) > 2.0 * term.release_height_m
    np.testing.assert_allclose(term.resting(still), 1.0)


def test_the_cost_of_a_moving_foot_grows_with_its_way_and_is_bounded() -> None:
    term = StillnessTerm(CAMERA, (HUMAN.point_names.index("ankle.L"),), STEP_S)
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
    term = StillnessTerm(CAMERA, points, STEP_S)
    deviation = np.zeros((FRAMES, DOFS))
    deviation[:, :3] = step_m * np.arange(FRAMES)[:, None]
    held = exercise(1)[np.zeros(FRAMES, dtype=np.intp)]
    at = ClipState(BODY, held, np.arange(FRAMES), np.eye(DOFS), deviation, np.zeros((FRAMES, 0)))
    return gradient(term, at)[0]


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
        STEP_S,
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


def test_a_body_behind_the_camera_is_not_compared_with_regions() -> None:
    tracks = film(exercise(FRAMES))
    behind = Posture.stack([exercise(FRAMES)[index] for index in range(FRAMES)])
    location = CAMERA.pose()[1]
    away = behind.translation + 2.0 * (location - behind.translation)
    at = replace(state(size=0.0), prior=Posture(HUMAN, away, behind.rotations, behind.angles))
    observed, count = ObservedRegions.from_tracks(tracks), len(MODEL.placements)
    widths = np.full((FRAMES, count), 20.0)
    term = RegionTerm(MODEL, observed, widths, np.ones(count), np.ones(count))
    at = replace(at, bias=np.zeros((FRAMES, count * FEATURES)))
    equations = NormalEquations(FRAMES, DOFS + count * FEATURES)
    term.add_to(equations, at, 1.0)
    assert np.isfinite(equations.gradient).all() and np.isfinite(term.cost(at)).all()
    assert not equations.gradient.any()


def test_information_of_regions_falls_with_noise_and_doubt() -> None:
    term, at = TERMS["regions"][0], state(size=0.0)
    assert isinstance(term, RegionTerm)
    predicted = MODEL.evaluate(at.pose, at.frame)
    nothing = np.zeros((FRAMES, len(SEGMENTS), FEATURES))
    sure = term.information(nothing, predicted)
    assert (sure > 0.0).any()
    doubted = replace(term, distrust=2.0 * term.distrust).information(nothing, predicted)
    assert (doubted[sure > 0.0] < sure[sure > 0.0]).all() and (doubted >= sure / 4.0 - 1e-12).all()


def test_annealing_widens_the_noise_of_images_alone() -> None:
    for name in ("keypoints", "ground"):
        term, at, _ = TERMS[name]
        cool, warm = (NormalEquations(FRAMES, DOFS) for _ in range(2))
        term.add_to(cool, at, 1.0)
        term.add_to(warm, at, 4.0)
        doubted = NormalEquations(FRAMES, DOFS)
        assert len(list(assembling(doubted, [term], at, 2.0, [2.0]))) == 2
        np.testing.assert_array_equal(doubted.gradient, warm.gradient)
        share = warm.matrix.diagonal.sum() / cool.matrix.diagonal.sum()
        assert share == pytest.approx(1.0) if name == "ground" else share < 0.9
