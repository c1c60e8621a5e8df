"""The likeliest sequence of stances through a clip, then of each limb on them.

A stance keeps its place, its lean and its heading from one frame to the next, but for what people do in that
time; a limb its points. Frames are tempered, since what makes one doubtful makes its neighbors doubtful.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray, SingleArray, single
from ..body.human import HIPS, LIMBS, SHOULDERS
from ..numerics.markov_chain import Step, cheapest_pairs, cheapest_path, path_posteriors
from ..numerics.robust import DEGREES, multivariate_cost
from ..progress import Part
from .composed_states import LEGS, FrameCosts, FrameStates
from .frame_likelihood import squared_distances
from .part_features import HEADINGS, StanceFeatures

SQUARE = [*SHOULDERS, *HIPS]


@dataclass(frozen=True, eq=False)
class ComposedPath:
    """The state of each of T frames and its limbs, all of the pools'."""

    stance: IndexArray  # (T,)
    hips: Array  # (T, 3) [m]
    limbs: IndexArray  # (T, 4), in the order of `LIMBS`
    posterior: list[SingleArray]  # t arrays (K,) of the probabilities of each frame's states
    limb_posterior: dict[str, Array]  # (T, L) probability of each part of a limb on the stances, by limb


def best_path(
    stances: StanceFeatures,
    states: Sequence[FrameStates],
    costs: Sequence[FrameCosts],
    others: Sequence[FrameCosts],
    time_s: Array,
    tempering: float,
    depth_step_m: float,
) -> Part[ComposedPath]:
    """The likeliest path through the states of T frames.

    `others` are the costs with left and right of the keypoints exchanged, none where that is not tried;
    `tempering` is the weight of a frame, `depth_step_m` the distance between the depths that were tried.
    """
    own, duration_s = [np.float32(tempering) * each.cost for each in states], np.diff(time_s)

    def step(at: int) -> SingleArray:
        after = at + 1
        return _step_cost(
            stances, states[at], states[after], costs[after], float(duration_s[at]), depth_step_m
        )

    best = cheapest_path(own, step)
    yield 0.2
    posterior = path_posteriors(own, step)
    yield 0.5
    stance = np.array([each.stance[row] for each, row in zip(states, best, strict=True)])
    hips = np.array([each.hips[row] for each, row in zip(states, best, strict=True)])
    chosen = [
        others[i] if each.exchanged[row] else costs[i]
        for i, (each, row) in enumerate(zip(states, best, strict=True))
    ]
    limbs, parts = limb_paths(stances, chosen, stance, hips, duration_s, np.float32(tempering))
    yield 1.0
    return ComposedPath(stance, hips.astype(float), limbs, posterior, parts)


def limb_paths(
    stances: StanceFeatures,
    costs: Sequence[FrameCosts],
    stance: IndexArray,
    hips: SingleArray,
    duration_s: Array,
    weight: np.float32,
) -> tuple[IndexArray, dict[str, Array]]:
    """(T, 4) the likeliest limbs on given stances at given places (T, 3), and each part's probability."""
    places = [single(place[None] - each.likelihood.location) for each, place in zip(costs, hips, strict=True)]
    tables = [
        {limb: cost.limb_table(limb, stance[[row]], places[row]) for limb in LIMBS}
        for row, cost in enumerate(costs)
    ]
    # Speed of elbows, wrists, knees and ankles [m/s], and how rough the pool is [m].
    variances = single((2.0 * duration_s) ** 2 + 0.09**2)

    def steps(limb: str, kept: Sequence[IndexArray | slice]) -> Step:
        def points(row: int) -> SingleArray:
            turn, origin = stances.frame_of(limb, stance[[row]])
            return stances.limbs[limb].points[kept[row]] @ turn[0].T + origin[0]

        def cost(at: int) -> SingleArray:
            moved = squared_distances(points(at), points(at + 1))
            return multivariate_cost(moved / variances[at], DEGREES, 3)

        return cost

    found = np.empty((len(stance), len(LIMBS)), dtype=np.intp)
    posterior: dict[str, Array] = {}
    for column, limb in enumerate(LIMBS):
        own = [weight * table[limb][0] for table in tables]
        every = steps(limb, [slice(None)] * len(stance))
        found[:, column] = cheapest_path(own, every)
        posterior[limb] = np.array(path_posteriors(own, every), dtype=float)
    pairs = [
        cost.leg_pairs(stance[[row]], places[row], tables[row], found[row][None])
        for row, cost in enumerate(costs)
    ]
    wholes = [weight * (left.cost[0][:, None] + right.cost[0] + both[0]) for left, right, both in pairs]
    rows = [[left.index[0] for left, _, _ in pairs], [right.index[0] for _, right, _ in pairs]]
    chosen = cheapest_pairs(wholes, *(steps(limb, own) for limb, own in zip(LEGS, rows, strict=True)))
    for limb, own, picks in zip(LEGS, rows, chosen, strict=True):
        found[:, LIMBS.index(limb)] = [row[pick] for row, pick in zip(own, picks, strict=True)]
    return found, posterior


def _step_cost(
    stances: StanceFeatures,
    before: FrameStates,
    after: FrameStates,
    cost: FrameCosts,
    duration_s: float,
    depth_step_m: float,
) -> SingleArray:
    """(J, K) costs of steps between the states of two frames."""
    points = stances.features.points[:, SQUARE]
    apart = squared_distances(points[before.stance], points[after.stance])
    # Speeds of shoulders and hips about the hips, and of the place [m/s]; how rough the pool is of both [m].
    turned = apart / np.float32((0.8 * duration_s) ** 2 + 0.06**2)
    across = (1.5 * duration_s) ** 2 + 0.04**2
    along = across + 0.5 * depth_step_m**2
    sight = cost.likelihood.backward.astype(float)
    covariance = across * np.eye(3) + (along - across) * np.outer(sight, sight)
    whiten = np.linalg.inv(np.linalg.cholesky(covariance)).T.astype(np.float32)
    moved = squared_distances((before.hips @ whiten)[:, None], (after.hips @ whiten)[:, None])
    # Largest cost of a step of the stance: evidence may be wrong for a while.
    total = np.minimum(turned + np.float32(0.5) * moved, np.float32(16.0))
    angle = stances.heading_rad[after.stance % HEADINGS]
    ahead = np.stack([np.sin(angle), -np.cos(angle)], axis=-1).astype(np.float32)  # facing -Y at 0
    gone = (after.hips[:, :2] * ahead).sum(axis=-1) - before.hips[:, :2] @ ahead.T
    limit = np.float32(4.0 * duration_s)
    # How much likelier it is that a performer goes forwards by a meter than not.
    total -= np.float32(1.5) * np.clip(gone, -limit, limit)
    return np.asarray(total)
