"""How well every posture of a library explains a frame in every heading, at the best place for it."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from .frame_likelihood import Sight, square_root
from .marker_moments import Solids
from .noise_scales import DEGREES

DEARER = 15.0
"""What explains a frame so much worse than the best is out of the question there, whatever comes before."""
EXTENTS_DIFFER = 6.0
"""The markers' extents make up for that much."""
MOST_STATES = 1500
"""States of a frame that are kept at most."""


@dataclass(frozen=True, eq=False)
class Turned:
    """What is to be known of N postures in each of H headings, for `sweep`."""

    heading_rad: Array
    """(H,)."""
    numbers: SingleArray
    """(3 M + 2, N H) the markers' middles, the height, 1."""
    spread: SingleArray
    """(M, 6, N H) entries xx, yy, zz, xy, xz, yz."""
    shape: tuple[int, int]
    """N, H."""


def turned(solids: Solids, headings: int) -> Turned:
    """All headings of some postures."""
    angle = 2.0 * np.pi * np.arange(headings) / headings
    c, s = np.cos(angle), np.sin(angle)
    turn = np.zeros((headings, 3, 3))
    turn[:, 0, 0], turn[:, 0, 1], turn[:, 1, 0], turn[:, 1, 1], turn[:, 2, 2] = c, -s, s, c, 1.0
    postures, markers = solids.middle.shape[:2]
    middle = np.einsum("hij,nmj->minh", turn, solids.middle)
    flat = np.ones((3 * markers + 2, postures * headings), dtype=np.float32)
    flat[:-2] = middle.reshape(3 * markers, -1)
    flat[-2] = np.repeat(solids.height, headings)
    spread = np.einsum("hia,nmab,hjb->mijnh", turn, solids.spread, turn, optimize=True)
    entries = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
    rows = np.stack([spread[:, i, j] for i, j in entries], axis=1).reshape(markers, 6, -1)
    return Turned(angle, flat, rows.astype(np.float32), (postures, headings))


@dataclass(frozen=True, eq=False)
class Fit:
    """The K states that explain a frame best; all others are out of the question there."""

    states: IndexArray
    """(K,) increasing."""
    cost: SingleArray
    """(K,) negative logarithm of the likelihood, up to a constant of the footage."""
    hips: SingleArray
    """(3, K) where the hips are [m]."""
    ground: SingleArray
    """(3, K) where the floor below them is, by the posture's height above it [m]."""

    def row(self, state: int) -> int:
        """Where a state is among the K; the best one's place where it is not among them."""
        row = int(np.searchsorted(self.states, state))
        known = row < len(self.states) and self.states[row] == state
        return row if known else int(self.cost.argmin())


def sweep(sight: Sight, turned: Turned, posed: SingleArray | None = None) -> Fit:
    """Find the states that explain a frame, each at the best place for it.

    Args:
        sight: What the footage says.
        turned: The states.
        posed: (N H,) what a posed keyframe costs them; None where the frame is not posed.
    """
    left = sight.left.astype(np.float32) @ turned.numbers  # (V, 2 M + 4, N H)
    left *= left
    costs = _student(left[:, -1], 1) + np.float32(sight.constant)
    for marker in np.flatnonzero(sight.seen):
        costs += _student(left[:, 2 * marker] + left[:, 2 * marker + 1], 2)
    if posed is not None:
        costs += _student(left[:, -4:-1].sum(axis=1), 3) + posed
    cost = costs.min(axis=0)
    states = _best(cost, DEARER + EXTENTS_DIFFER, 2 * MOST_STATES)
    cost, doubted = cost[states], costs[:, states].argmin(axis=0)
    numbers = turned.numbers[:, states]
    hips = np.empty((3, len(states)), dtype=np.float32)
    for way, place in enumerate(sight.place.astype(np.float32)):
        own = doubted == way
        hips[:, own] = place @ numbers[:, own]
    back = sight.backward.astype(np.float32)
    nearness = np.float32(sight.backward @ sight.location) - back @ hips
    for marker in np.flatnonzero(sight.whole):
        middle = numbers[3 * marker : 3 * marker + 3]
        depth = np.maximum(nearness - back @ middle, np.float32(0.1))
        cost += _student(_extent_error(sight, turned.spread[marker][:, states], marker, depth), 3)
    cost[nearness < 0.3] += np.float32(1e3)
    kept = _best(cost, DEARER, MOST_STATES)
    ground = hips[:, kept]
    ground[2] -= numbers[-2, kept]
    return Fit(states[kept], cost[kept], hips[:, kept], ground)


def _best(cost: SingleArray, dearer: float, most: int) -> IndexArray:
    """Which are at most so much dearer than the cheapest, and how many at most."""
    kept = np.flatnonzero(cost <= cost.min() + np.float32(dearer))
    if len(kept) > most:
        kept = np.sort(kept[np.argpartition(cost[kept], most)[:most]])
    return kept


def _extent_error(sight: Sight, spread: SingleArray, marker: int, depth: SingleArray) -> SingleArray:
    """Squared difference of the extents seen and predicted, in standard deviations."""
    a, b = sight.axes[marker]
    product = [(a, a), (a, b), (b, b)]
    rows = np.array([_products(u, v) for u, v in product], dtype=np.float32)
    predicted = square_root(*(rows @ spread))
    observed = sight.root[marker].astype(np.float32)
    variance = np.float32(sight.root_std_m[marker] ** 2) + (np.float32(sight.pixel) * depth) ** 2
    squared = sum(
        (predicted[k] - observed[k] * depth) ** 2 * np.float32(2.0 if k == 1 else 1.0) for k in range(3)
    )
    return np.asarray(squared / variance)


def _products(u: Array, v: Array) -> list[float]:
    """Factors of the six entries of a symmetric matrix S in u S v."""
    return [
        u[0] * v[0],
        u[1] * v[1],
        u[2] * v[2],
        u[0] * v[1] + u[1] * v[0],
        u[0] * v[2] + u[2] * v[0],
        u[1] * v[2] + u[2] * v[1],
    ]


def _student(squared: SingleArray, dimensions: int) -> SingleArray:
    factor = np.float32(0.5 * (DEGREES + dimensions))
    return np.asarray(factor * np.log1p(squared / np.float32(DEGREES)))
