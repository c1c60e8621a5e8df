"""Cheapest paths through states and through pairs, against all paths one by one."""

from itertools import product

import numpy as np
from keymark.core.numerics.markov_chain import cheapest_pairs, cheapest_path, path_posteriors

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
        assert tuple(cheapest_path(rows, steps)) == best


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
        found = cheapest_pairs(own, first, second)
        assert (tuple(found[0]), tuple(found[1])) == best


def test_probabilities_are_those_of_all_paths() -> None:
    own, steps, _ = made(7)
    rows = [each[0] for each in own]
    total = [np.zeros(ROWS) for _ in range(FRAMES)]
    for path in product(range(ROWS), repeat=FRAMES):
        cost = sum(row[i] for row, i in zip(rows, path, strict=True))
        cost += sum(step[a, b] for step, a, b in zip(steps, path[:-1], path[1:], strict=True))
        for frame, row in enumerate(path):
            total[frame][row] += np.exp(-cost)
    for found, wanted in zip(path_posteriors(rows, steps), total, strict=True):
        assert np.allclose(found, wanted / wanted.sum(), atol=1e-4)
