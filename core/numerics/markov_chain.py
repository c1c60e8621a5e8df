"""Paths through a Markov chain: the likeliest one, and the probability of each state given all times.

States have costs (negative log likelihoods), and so have the steps between those of two times.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array, IndexArray, SingleArray


def cheapest_path(own: Sequence[Array | SingleArray], steps: Sequence[Array | SingleArray]) -> IndexArray:
    """(T,) the states of the cheapest path (Viterbi 1967).

    `own`: T arrays (K,) of the states' costs; `steps`: T - 1 arrays (J, K) of the steps' from each state to
    each next.
    """
    total, sources = own[0], []
    for step, cost in zip(steps, own[1:], strict=True):
        through = total[:, None] + step
        source = through.argmin(axis=0)
        sources.append(source)
        total = through[source, np.arange(len(cost))] + cost
    rows = [int(total.argmin())]
    for source in reversed(sources):
        rows.append(int(source[rows[-1]]))
    return np.array(rows[::-1], dtype=np.intp)


def cheapest_pairs(
    own: Sequence[SingleArray], first: Sequence[SingleArray], second: Sequence[SingleArray]
) -> tuple[IndexArray, IndexArray]:
    """The cheapest path of pairs whose halves step each on their own: rows and columns (T,).

    `own`: T arrays (J, K) of the pairs' costs; `first` and `second`: T - 1 arrays (J, J') and (K, K') of the
    steps' costs.
    """
    total, sources = own[0], []
    for one, other, cost in zip(first, second, own[1:], strict=True):
        through = total[:, None, :] + one[:, :, None]  # (J, J', K)
        row = through.argmin(axis=0)
        nearer = through.min(axis=0)[:, :, None] + other  # (J', K, K')
        column = nearer.argmin(axis=1)
        sources.append((row, column))
        total = nearer.min(axis=1) + cost
    pick = np.unravel_index(int(total.argmin()), total.shape)
    path = [(int(pick[0]), int(pick[1]))]
    for row, column in reversed(sources):
        after, beside = path[-1]
        before = int(column[after, beside])
        path.append((int(row[after, before]), before))
    found = np.array(path[::-1], dtype=np.intp)
    return found[:, 0], found[:, 1]


def path_posteriors(own: Sequence[SingleArray], steps: Sequence[SingleArray]) -> list[SingleArray]:
    """T arrays (K,) of the states' probabilities given all times (forward-backward)."""
    chance = [np.exp(-step) for step in steps]
    forward = [_normalized(np.exp(own[0].min() - own[0]))]
    for step, cost in zip(chance, own[1:], strict=True):
        forward.append(_normalized((forward[-1] @ step) * np.exp(cost.min() - cost)))
    backward = np.ones_like(own[-1])
    found = [forward[-1]]
    for index in range(len(own) - 2, -1, -1):
        later = own[index + 1]
        backward = _normalized(chance[index] @ (backward * np.exp(later.min() - later)))
        found.append(_normalized(forward[index] * backward))
    return found[::-1]


def _normalized(share: SingleArray) -> SingleArray:
    total = share.sum()
    if not total > 0.0:
        return np.full_like(share, 1.0 / len(share))
    return np.asarray(share / total)
