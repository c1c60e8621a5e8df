"""Paths through a Markov chain: the likeliest one, and the probability of each state given all times.

States have costs (negative log likelihoods), and so have the steps between those of two times.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..arrays import Array, BoolArray, IndexArray, SingleArray

Step = Callable[[int], Any]
"""Gives the costs (J, K) of the steps from the states of a time to those of the next. It is asked again and
again, so that the memory of one time is needed."""


def cheapest_path(own: Sequence[Array | SingleArray], step: Step) -> IndexArray:
    """(T,) the states of the cheapest path (Viterbi 1967); `own` are T arrays (K,) of the states' costs."""
    total, sources = own[0], []
    for at, cost in enumerate(own[1:]):
        through = total[:, None] + step(at)
        source = through.argmin(axis=0)
        sources.append(source)
        total = through[source, np.arange(len(cost))] + cost
    rows = [int(total.argmin())]
    for source in reversed(sources):
        rows.append(int(source[rows[-1]]))
    return np.array(rows[::-1], dtype=np.intp)


def exchanged_path(own: Array, stays: Array, turns: Array) -> BoolArray:
    """(F,) in which frames two things have changed places on the cheapest path.

    `own`: (F, 2) costs of both kept and both exchanged; `stays` and `turns`: (F - 1,) costs of what moves on
    from a frame as it was, and with an exchange.
    """
    steps = np.stack([np.stack([stays, turns], axis=-1), np.stack([turns, stays], axis=-1)], axis=-2)
    return cheapest_path(list(own), list(steps).__getitem__).astype(bool)


NOBODY = -1


def cheapest_track(
    first: IndexArray,
    own: Array,
    absent: Array,
    restart: float,
    reach: int,
    step_costs: Callable[[IndexArray, IndexArray], Array],
    taken: Callable[[IndexArray, IndexArray], None] = lambda here, source: None,
) -> IndexArray:
    """(F,) which of the items of each frame is the one that is followed, `NOBODY` where none is.

    Args:
        first: (F + 1,) index of each frame's first item; items of a frame follow one another.
        own: (N,) cost of each item.
        absent: (F,) cost of no item in a frame.
        restart: Cost of a step from any item of any earlier frame.
        reach: Frames back to which steps have costs of their own.
        step_costs: Gives costs (H, S) of steps to H items of a frame from S of the frames before.
        taken: Hears of H items of a frame the items before them on the cheapest path, `NOBODY` where it
            begins with them or begins anew.
    """
    starts = first.tolist()
    before = np.concatenate([[0.0], np.cumsum(absent)])  # of all frames before each
    frame = np.repeat(np.arange(len(absent)), np.diff(first))
    total, source = np.array(own, dtype=float), np.full(len(own), NOBODY, dtype=np.intp)
    ahead = np.empty(len(own))  # `total` without the frames before
    end, last = float(before[-1]), NOBODY
    least, leader = np.inf, NOBODY  # of all paths that have ended
    for now, (begin, stop) in enumerate(zip(starts, starts[1:], strict=False)):
        if begin == stop:
            continue
        here = np.arange(begin, stop)
        reached, where = np.full(stop - begin, before[now]), np.full(stop - begin, NOBODY)
        anew = least + before[now] + restart
        if anew < before[now]:
            reached[:], where[:] = anew, leader
        earliest = starts[max(now - reach, 0)]
        near = np.arange(earliest, begin)
        # No way from anywhere else is dearer than to begin anew.
        near = near[ahead[near] <= min(least + restart, 0.0)]
        known = np.full(stop - begin, NOBODY)
        if len(near):
            through = ahead[near] + before[now] + step_costs(here, near)
            best = through.argmin(axis=1)
            cost = through[np.arange(len(best)), best]
            better = cost < reached
            reached, where = np.where(better, cost, reached), np.where(better, near[best], where)
            known = np.where(better, near[best], NOBODY)
        taken(here, known)
        total[here] += reached
        source[here] = where
        ahead[here] = total[here] - before[now + 1]
        best_here = begin + int(ahead[begin:stop].argmin())
        if ahead[best_here] < least:
            least, leader = float(ahead[best_here]), best_here
        if ahead[best_here] + before[-1] < end:
            end, last = float(ahead[best_here] + before[-1]), best_here
    track = np.full(len(absent), NOBODY, dtype=np.intp)
    while last != NOBODY:
        track[frame[last]] = last
        last = int(source[last])
    return track


def cheapest_pairs(own: Sequence[SingleArray], first: Step, second: Step) -> tuple[IndexArray, IndexArray]:
    """The cheapest path of pairs whose halves step each on their own: rows and columns (T,).

    `own` are T arrays (J, K) of the pairs' costs.
    """
    total, sources = own[0], []
    for at, cost in enumerate(own[1:]):
        through = total[:, None, :] + first(at)[:, :, None]  # (J, J', K)
        row = through.argmin(axis=0)
        nearer = through.min(axis=0)[:, :, None] + second(at)  # (J', K, K')
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


def path_posteriors(own: Sequence[SingleArray], step: Step) -> list[SingleArray]:
    """T arrays (K,) of the states' probabilities given all times (forward-backward)."""
    forward = [_normalized(np.exp(own[0].min() - own[0]))]
    for at, cost in enumerate(own[1:]):
        forward.append(_normalized((forward[-1] @ np.exp(-step(at))) * np.exp(cost.min() - cost)))
    backward = np.ones_like(own[-1])
    found = [forward[-1]]
    for at in reversed(range(len(own) - 1)):
        later = own[at + 1]
        backward = _normalized(np.exp(-step(at)) @ (backward * np.exp(later.min() - later)))
        found.append(_normalized(forward[at] * backward))
    return found[::-1]


def _normalized(share: SingleArray) -> SingleArray:
    total = share.sum()
    if not total > 0.0:
        return np.full_like(share, 1.0 / len(share))
    return np.asarray(share / total)
