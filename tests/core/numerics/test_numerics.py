"""Numerical methods."""

import weakref
from itertools import product

import numpy as np
import pytest
from _performances import jitter_mm, seen_by_network
from keymark.core.arrays import Array
from keymark.core.numerics.markov_chain import (
    NOBODY,
    cheapest_pairs,
    cheapest_path,
    cheapest_track,
    exchanged_path,
    path_posteriors,
)
from keymark.core.numerics.robust import (
    Equations,
    levenberg_marquardt,
    multivariate_cost,
    student_cost,
    student_weight,
)
from keymark.core.numerics.vectors import across, columns_at, gaussian, unit, usual_step, weighted_median
from keymark.core.numerics.wandering import learn_sizes, smooth_path
from scipy.optimize import least_squares
from scipy.stats import multivariate_t, t


@pytest.mark.parametrize(("degrees", "dimensions"), [(3.0, 1), (4.0, 2), (4.0, 3)])
def test_costs_are_those_of_students_t(degrees: float, dimensions: int) -> None:
    rows = np.random.default_rng(1).normal(0.0, 4.0, (20, dimensions))
    density = multivariate_t(np.zeros(dimensions), np.eye(dimensions), degrees)
    expected = density.logpdf(np.zeros(dimensions)) - density.logpdf(rows)
    np.testing.assert_allclose(multivariate_cost((rows**2).sum(-1), degrees, dimensions), expected)
    one = t(degrees).logpdf(0.0) - t(degrees).logpdf(rows[:, 0])
    np.testing.assert_allclose(multivariate_cost(rows[:, 0] ** 2, degrees, 1), one)


@pytest.mark.parametrize("count", [1, 3])
def test_weights_are_slopes_of_costs(count: int) -> None:
    squared, step = np.linspace(0.1, 30.0, 12), 1e-5
    for cost, weight in (
        (lambda s: student_cost(s, 4.0, count), student_weight(squared, 4.0, count)),
        (lambda s: multivariate_cost(s, 4.0, count), (4.0 + count) / (4.0 + squared)),
    ):
        slope = (cost(squared + step) - cost(squared - step)) / (2.0 * step)
        np.testing.assert_allclose(2.0 * slope, weight, rtol=1e-6)
    assert student_weight(np.zeros(1), 4.0, count)[0] == 1.0


def test_costs_keep_single_precision() -> None:
    assert multivariate_cost(np.ones(3, dtype=np.float32), 4.0, 2).dtype == np.float32


def test_directions_are_one_long_and_across() -> None:
    vectors = np.vstack([np.random.default_rng(2).normal(size=(20, 3)), np.eye(3), -np.eye(3)])
    np.testing.assert_allclose(np.linalg.norm(unit(vectors), axis=-1), 1.0)
    np.testing.assert_allclose(np.cross(unit(vectors), vectors), 0.0, atol=1e-12)
    assert (np.sum(unit(vectors) * vectors, axis=-1) > 0.0).all()
    assert np.isfinite(unit(np.zeros((2, 3)))).all()
    for vector in vectors:
        assert across(vector) @ vector == pytest.approx(0.0, abs=1e-12)
        assert np.linalg.norm(across(vector)) == pytest.approx(1.0)


def test_columns_are_interpolated_one_by_one() -> None:
    values = np.array([[0.0, 10.0], [2.0, 30.0]])
    found = columns_at(np.array([-1.0, 1.0, 2.0, 9.0]), np.array([1.0, 3.0]), values)
    np.testing.assert_allclose(found, [[0.0, 10.0], [0.0, 10.0], [1.0, 20.0], [2.0, 30.0]])


def test_a_gaussian_is_the_sum_by_brute_force() -> None:
    values = np.random.default_rng(3).normal(size=(30, 2))
    offsets = np.arange(-8, 9)
    kernel = np.exp(-0.5 * (offsets / 2.0) ** 2)
    rows = np.clip(np.arange(30)[:, None] + offsets, 0, 29)
    expected = np.einsum("k,fkc->fc", kernel / kernel.sum(), values[rows])
    np.testing.assert_allclose(gaussian(values, 2.0), expected, atol=1e-12)
    assert gaussian(values, 0.0) is values and gaussian(values[:1], 2.0).shape == (1, 2)


def test_the_usual_step_leaves_out_what_does_not_advance() -> None:
    assert usual_step(np.array([0.0, 0.1, 0.1, 0.2, np.nan, 0.3, 0.2, 0.3])) == pytest.approx(0.1)
    assert usual_step(np.array([4.0])) == 1.0 == usual_step(np.array([4.0, 4.0]))


def test_a_weighted_median_counts_each_value_as_often_as_it_weighs() -> None:
    rng = np.random.default_rng(4)
    for _ in range(30):
        values, weights = rng.normal(size=7), rng.integers(0, 5, 7)
        weights[0] += 1
        repeated = np.sort(np.repeat(values, weights))
        assert weighted_median(values, weights) == repeated[(len(repeated) - 1) // 2]


def test_levenberg_marquardt_finds_what_scipy_finds() -> None:
    rng = np.random.default_rng(5)
    at = np.linspace(0.0, 2.0, 15)
    true = rng.uniform(0.5, 2.0, (6, 2))
    seen = true[:, :1] * np.exp(-true[:, 1:] * at) + rng.normal(0.0, 0.02, (6, 15))

    def rows(x: Array, of: slice | int = slice(None)) -> Array:
        return x[..., :1] * np.exp(-x[..., 1:] * at) - seen[of]

    def equations(x: Array) -> Equations:
        fall = np.exp(-x[:, 1:] * at)
        jacobian = np.stack([fall, -x[:, :1] * at * fall], axis=-1)  # (N, R, 2)
        error = rows(x)
        normal = np.swapaxes(jacobian, 1, 2) @ jacobian
        return (error**2).sum(-1), normal, np.einsum("nrd,nr->nd", jacobian, error)

    def choose(mask: np.ndarray, first: Array, second: Array) -> Array:
        return np.where(mask[:, None], first, second)

    start = np.array([[3.0, 0.2]] * 6)
    found = levenberg_marquardt(equations, start, np.add, choose, 100, 1e-12)
    for index in range(6):
        best = least_squares(
            lambda x, of=index: rows(x, of), start[index], xtol=1e-14, ftol=1e-14, gtol=1e-14
        )
        np.testing.assert_allclose(found[index], best.x, rtol=1e-5)
    again = levenberg_marquardt(equations, found, np.add, choose, 100, 1e-12)
    np.testing.assert_allclose(again, found, rtol=1e-6)
    calls: list[float] = []

    def counted(x: Array, factor: float) -> Equations:
        calls.append(factor)
        cost, normal, gradient = equations(x)
        return factor * cost, factor * normal, factor * gradient

    def evaluations(factor: float, converged: float) -> int:
        calls.clear()
        levenberg_marquardt(lambda x: counted(x, factor), start, np.add, choose, 100, converged)
        return len(calls)

    few, many, scaled = evaluations(1.0, 0.5), evaluations(1.0, 1e-6), evaluations(1e3, 1e-6)
    assert few < many < 60 and abs(scaled - many) <= 5


FRAMES, ROWS = 4, 3


def made(seed: int) -> tuple[list[np.ndarray], list[np.ndarray], list[np.ndarray]]:
    """Costs of rows, and of steps of two chains."""
    rng = np.random.default_rng(seed)
    own = [rng.exponential(2.0, (ROWS, ROWS)).astype(np.float32) for _ in range(FRAMES)]
    steps = [
        [rng.exponential(2.0, (ROWS, ROWS)).astype(np.float32) for _ in range(FRAMES - 1)] for _ in range(2)
    ]
    return own, steps[0], steps[1]


def test_the_cheapest_path_is_the_cheapest_of_all() -> None:
    for seed in range(5):
        own, steps, _ = made(seed)
        rows = [each[0] for each in own]

        def cost(path: tuple[int, ...], rows=rows, steps=steps) -> float:
            moved = sum(step[a, b] for step, a, b in zip(steps, path[:-1], path[1:], strict=True))
            return float(sum(row[i] for row, i in zip(rows, path, strict=True)) + moved)

        best = min(product(range(ROWS), repeat=FRAMES), key=cost)
        assert tuple(cheapest_path(rows, steps.__getitem__)) == best


def test_the_cheapest_pairs_are_the_cheapest_of_all() -> None:
    for seed in range(3):
        own, first, second = made(seed)

        def cost(paths, own=own, first=first, second=second) -> float:
            one, two = paths
            total = sum(each[i, j] for each, i, j in zip(own, one, two, strict=True))
            total += sum(step[a, b] for step, a, b in zip(first, one[:-1], one[1:], strict=True))
            return float(
                total + sum(step[a, b] for step, a, b in zip(second, two[:-1], two[1:], strict=True))
            )

        every = list(product(range(ROWS), repeat=FRAMES))
        best = min(product(every, every), key=cost)
        found = cheapest_pairs(own, first.__getitem__, second.__getitem__)
        assert (tuple(found[0]), tuple(found[1])) == best


def test_what_is_exchanged_is_the_cheaper_of_both_ways_all_along() -> None:
    own, stays, turns = (np.random.default_rng(seed).exponential(2.0, size)
                         for seed, size in ((8, (6, 2)), (9, 5), (10, 5)))  # fmt: skip

    def cost(path: tuple[int, ...]) -> float:
        moved = np.where(np.diff(path) == 0, stays, turns)
        return float(own[np.arange(6), list(path)].sum() + moved.sum())

    assert tuple(exchanged_path(own, stays, turns)) == min(product((0, 1), repeat=6), key=cost)


@pytest.mark.parametrize("seed", range(6))
def test_the_cheapest_track_is_the_cheapest_of_all_that_leave_frames_out(seed: int) -> None:
    rng = np.random.default_rng(seed)
    counts = np.array([2, 0, 2, 1, 2])
    first = np.concatenate([[0], np.cumsum(counts)])
    frame = np.repeat(np.arange(5), counts)
    own, absent = rng.exponential(0.5, 7), rng.exponential(1.0, 5)
    step, restart, reach = rng.exponential(2.0, (7, 7)), 1.5, 2

    def cost(path: tuple[int, ...]) -> float:
        seen = [item for item in path if item != NOBODY]
        total = sum(own[item] for item in seen) + sum(absent[f] for f, item in enumerate(path) if item < 0)
        for before, now in zip(seen, seen[1:], strict=False):
            near = frame[now] - frame[before] <= reach
            total += min(step[before, now], restart) if near else restart
        return float(total)

    heard: dict[int, int] = {}

    def taken(here: np.ndarray, source: np.ndarray) -> None:
        heard.update(zip(here.tolist(), source.tolist(), strict=True))

    choices = [(NOBODY, *range(a, b)) for a, b in zip(first, first[1:], strict=False)]
    found = cheapest_track(first, own, absent, restart, reach, lambda h, b: step[np.ix_(b, h)].T, taken)
    best = min(product(*choices), key=cost)
    assert tuple(found) == best
    assert sorted(heard) == list(range(7)) and all(frame[s] < frame[h] for h, s in heard.items() if s >= 0)


def test_probabilities_are_those_of_all_paths() -> None:
    own, steps, _ = made(7)
    rows = [each[0] for each in own]
    total = [np.zeros(ROWS) for _ in range(FRAMES)]
    for path in product(range(ROWS), repeat=FRAMES):
        cost = sum(row[i] for row, i in zip(rows, path, strict=True))
        cost += sum(step[a, b] for step, a, b in zip(steps, path[:-1], path[1:], strict=True))
        for frame, row in enumerate(path):
            total[frame][row] += np.exp(-cost)
    for found, wanted in zip(path_posteriors(rows, steps.__getitem__), total, strict=True):
        assert np.allclose(found, wanted / wanted.sum(), atol=1e-4)


def test_costs_of_steps_are_not_kept() -> None:
    """What is kept does not grow with the square of the states a time."""
    rng = np.random.default_rng(11)
    fixed = [rng.exponential(2.0, (ROWS, ROWS)).astype(np.float32) for _ in range(40)]
    own = [rng.exponential(2.0, ROWS).astype(np.float32) for _ in range(41)]
    alive: weakref.WeakSet[object] = weakref.WeakSet()
    most = 0

    class Counted(np.ndarray):
        """An array that can be told from others while it is kept."""

        __hash__ = object.__hash__  # type: ignore[assignment]

    def cost(at: int) -> np.ndarray:
        nonlocal most
        made = fixed[at].copy().view(Counted)
        alive.add(made)
        most = max(most, len(alive))
        return made

    kept = fixed.__getitem__
    np.testing.assert_array_equal(cheapest_path(own, cost), cheapest_path(own, kept))
    for found, wanted in zip(path_posteriors(own, cost), path_posteriors(own, kept), strict=True):
        np.testing.assert_array_equal(found, wanted)
    assert most <= 3


TIME_S = np.arange(150) / 30.0


def swinging(hertz: float) -> np.ndarray:
    """(F, 4, 3) points that swing by 20 cm."""
    phases = np.arange(12).reshape(4, 3)
    return 0.2 * np.sin(2.0 * np.pi * hertz * TIME_S[:, None, None] + phases)


def smoothed(values: np.ndarray) -> np.ndarray:
    sizes = learn_sizes(values, 30.0)
    return np.stack([smooth_path(values[:, point], sizes) for point in range(values.shape[1])], axis=1)


@pytest.mark.parametrize("hertz", [0.2, 1.0, 2.5])
def test_what_swings_slowly_is_smoothed_more(hertz: float) -> None:
    truth = swinging(hertz)
    given = seen_by_network(truth, place_m=0.0)
    path = smoothed(given)
    assert jitter_mm(path) < 1.5 * jitter_mm(truth) + 1.0
    assert jitter_mm(given) > 25.0
    assert np.abs(path - truth).mean() < 1.02 * np.abs(given - truth).mean()


def test_sizes_do_not_depend_on_units_and_hardly_on_frames_left_out() -> None:
    given = seen_by_network(swinging(1.0))
    sizes = learn_sizes(given, 30.0)
    assert learn_sizes(100.0 * given, 30.0) == sizes
    given[::10] = np.nan
    assert abs(np.log10(learn_sizes(given, 30.0).bend / sizes.bend)) < 0.3


def test_missing_values_are_filled_and_leaping_ones_forgiven() -> None:
    truth = swinging(0.5)
    given = seen_by_network(truth, bias_m=0.005, place_m=0.0)
    given[40:46] = np.nan
    given[90] += 0.5
    path = smoothed(given)
    assert np.isfinite(path).all()
    assert np.abs(path[40:46] - truth[40:46]).max() < 0.05
    assert np.abs(path[90] - truth[90]).max() < 0.05


def test_an_exact_frame_is_met_and_tells_the_error_beside_it() -> None:
    truth = swinging(1.0)[:, 0]
    given = seen_by_network(truth[:, None], 3, bias_m=0.05, place_m=0.0)[:, 0]
    sizes = learn_sizes(given[:, None], 30.0)
    frames = np.array([30, 75, 120])
    plain = smooth_path(given, sizes)
    corrected = smooth_path(given, sizes, frames, truth[frames])
    np.testing.assert_allclose(corrected[frames], truth[frames], atol=2e-3)
    beside = np.unique(frames[:, None] + np.arange(-6, 7))
    error = [np.linalg.norm(path - truth, axis=1) for path in (plain, corrected)]
    assert error[1][beside].mean() < 0.75 * error[0][beside].mean()
    assert error[1].mean() < error[0].mean()
