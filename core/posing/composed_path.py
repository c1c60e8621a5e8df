"""The likeliest sequence of stances through a clip, then of each limb on them.

A stance keeps its place, its lean and its heading from one frame to the next, but for what people do in that
time; a limb its points. Frames are tempered, since what makes one doubtful makes its neighbors doubtful.
"""

from collections.abc import Generator, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.human import HUMAN, LIMBS
from ..numerics.markov_chain import cheapest_pairs, cheapest_path, path_posteriors
from .composed_states import LEGS, FrameCosts, FrameStates
from .match_evidence import squared_distances, student_cost
from .part_features import HEADINGS, StanceFeatures

TRUNK_POINTS = [HUMAN.point_names.index(f"{name}.{side}") for name in ("shoulder", "hip") for side in "LR"]
TRUNK_SPEED, TRUNK_ROUGH_M = 0.8, 0.06  # of shoulders and hips about the hips [m/s]; of the pool [m]
PLACE_SPEED, PLACE_ROUGH_M = 1.5, 0.04  # the same of the place
LIMB_SPEED, LIMB_ROUGH_M = 2.0, 0.09  # the same of elbows, wrists, knees and ankles


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
) -> Generator[float, None, ComposedPath]:
    """The likeliest path through the states of T frames.

    Args:
        stances: All stances.
        states: Those of each frame.
        costs: What each frame says.
        others: The same with left and right of the keypoints exchanged; none where that is not tried.
        time_s: (T,) times of the frames.
        tempering: Weight of a frame.
        depth_step_m: Distance between the depths that were tried.
    """
    steps = []
    for index in range(1, len(states)):
        duration = float(time_s[index] - time_s[index - 1])
        steps.append(
            _step_cost(stances, states[index - 1], states[index], costs[index], duration, depth_step_m)
        )
        if index % 8 == 0:
            yield 0.5 * index / len(states)
    own = [np.float32(tempering) * each.cost for each in states]
    best = cheapest_path(own, steps)
    posterior = path_posteriors(own, steps)
    stance = np.array([each.stance[row] for each, row in zip(states, best, strict=True)])
    hips = np.array([each.hips[row] for each, row in zip(states, best, strict=True)], dtype=float)
    swapped = [bool(each.exchanged[row]) for each, row in zip(states, best, strict=True)]
    said = [others[i] if swap else cost for i, (cost, swap) in enumerate(zip(costs, swapped, strict=True))]
    limbs, parts = limb_paths(stances, said, stance, hips, time_s, tempering)
    yield 1.0
    return ComposedPath(stance, hips, limbs, posterior, parts)


def limb_paths(
    stances: StanceFeatures,
    costs: Sequence[FrameCosts],
    stance: IndexArray,
    hips: Array,
    time_s: Array,
    tempering: float,
) -> tuple[IndexArray, dict[str, Array]]:
    """(T, 4) the likeliest limbs on given stances at given places (T, 3), and each part's probability."""
    tables: list[dict[str, SingleArray]] = []
    for cost, own, place in zip(costs, stance, hips, strict=True):
        relative = (place[None] - cost.location).astype(np.float32)
        tables.append({limb: cost.limb_table(limb, np.array([own]), relative) for limb in LIMBS})
    variances = [np.float32((LIMB_SPEED * step) ** 2 + LIMB_ROUGH_M**2) for step in np.diff(time_s)]
    points = {}
    for limb in LIMBS:
        turn, origin = stances.frame_of(limb, stance)
        points[limb] = np.einsum("tij,lqj->tlqi", turn, stances.limbs[limb].points) + origin[:, None, None]
    found = np.empty((len(stance), len(LIMBS)), dtype=np.intp)

    def steps(limb: str, rows: Sequence[IndexArray | slice]) -> list[SingleArray]:
        moved = zip(points[limb][:-1], points[limb][1:], rows[:-1], rows[1:], variances, strict=True)
        return [
            student_cost(squared_distances(before[own], after[other]) / variance, 3)
            for before, after, own, other, variance in moved
        ]

    weight = np.float32(tempering)
    posterior: dict[str, Array] = {}
    for column, limb in enumerate(LIMBS):
        own_costs = [weight * table[limb][0] for table in tables]
        all_steps = steps(limb, [slice(None)] * len(stance))
        found[:, column] = cheapest_path(own_costs, all_steps)
        posterior[limb] = np.array(path_posteriors(own_costs, all_steps), dtype=float)
    chosen = []
    for row, (cost, own, place) in enumerate(zip(costs, stance, hips, strict=True)):
        relative = (place[None] - cost.location).astype(np.float32)
        chosen.append(cost.leg_pairs(np.array([own]), relative, tables[row], found[row][None]))
    rows = [[left.index[0] for left, _, _ in chosen], [right.index[0] for _, right, _ in chosen]]
    wholes = [weight * (a.cost[0][:, None] + b.cost[0] + pairs[0]) for a, b, pairs in chosen]
    both = cheapest_pairs(wholes, *(steps(limb, own) for limb, own in zip(LEGS, rows, strict=True)))
    for side, limb in enumerate(LEGS):
        found[:, LIMBS.index(limb)] = [own[pick] for own, pick in zip(rows[side], both[side], strict=True)]
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
    points = stances.features.points[:, TRUNK_POINTS]
    apart = squared_distances(points[before.stance], points[after.stance])
    turned = apart / np.float32((TRUNK_SPEED * duration_s) ** 2 + TRUNK_ROUGH_M**2)
    across = (PLACE_SPEED * duration_s) ** 2 + PLACE_ROUGH_M**2
    along = across + 0.5 * depth_step_m**2
    sight = cost.backward.astype(float)
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
