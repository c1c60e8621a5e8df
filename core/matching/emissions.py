"""Emission likelihoods of a frame: every posture of a library in every heading, each at its best place."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray, SingleArray
from .frame_likelihood import FrameLikelihood, square_root
from .marker_moments import MarkerMoments
from .noise_scales import student_cost

PRUNING_COST = 15.0
"""States whose cost exceeds the frame's least by more are pruned, whatever precedes them."""
EXTENT_COST = 6.0
"""Additional margin before the markers' extents are compared, which may change the order by this much."""
VARIANT_COST = 6.0
"""The same before each group of points in turn is hardly counted for the hips' place."""
EXCHANGED_COST = np.float32(3.0)
"""Cost of taking a detector's left for right in a frame: one in twenty."""
MOST_STATES = 1500
"""States kept of a frame."""


@dataclass(frozen=True, eq=False)
class StateFeatures:
    """Features of all states, N postures in each of H headings, in which residuals are linear."""

    heading_rad: Array
    """(H,)."""
    vectors: SingleArray
    """(3 A + 2, N H) the places of markers and keypoints relative to the hips, the hips' height above the
    floor [m], and 1."""
    second_moment: SingleArray
    """(M, 6, N H) entries xx, yy, zz, xy, xz, yz of each marker's [m²]."""
    shape: tuple[int, int]
    """N, H."""


def state_features(moments: MarkerMoments, headings: int) -> StateFeatures:
    """Features of some postures in all headings."""
    angle = 2.0 * np.pi * np.arange(headings) / headings
    c, s = np.cos(angle), np.sin(angle)
    turn = np.zeros((headings, 3, 3))
    turn[:, 0, 0], turn[:, 0, 1], turn[:, 1, 0], turn[:, 1, 1], turn[:, 2, 2] = c, -s, s, c, 1.0
    postures, points = moments.centroid.shape[:2]
    centroid = np.einsum("hij,nmj->minh", turn, moments.centroid)
    flat = np.ones((3 * points + 2, postures * headings), dtype=np.float32)
    flat[:-2] = centroid.reshape(3 * points, -1)
    flat[-2] = np.repeat(moments.hip_height_m, headings)
    second_moment = np.einsum("hia,nmab,hjb->mijnh", turn, moments.second_moment, turn, optimize=True)
    entries = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
    rows = np.stack([second_moment[:, i, j] for i, j in entries], axis=1)
    rows = rows.reshape(len(rows), 6, postures * headings)
    return StateFeatures(angle, flat, rows.astype(np.float32), (postures, headings))


@dataclass(frozen=True, eq=False)
class FrameEmissions:
    """The K states that explain a frame best; all others are pruned."""

    states: IndexArray
    """(K,) increasing."""
    cost: SingleArray
    """(K,) negative log likelihood, up to a constant of the footage."""
    hips: SingleArray
    """(3, K) places of the hips [m]."""
    ground: SingleArray
    """(3, K) the floor below them, by each posture's height above it [m]."""
    exchanged: BoolArray
    """(K,) whether left and right of the keypoints are exchanged for it."""

    def index_of(self, state: int) -> int:
        """Index of a state among the K; that of the cheapest where it was pruned."""
        index = int(np.searchsorted(self.states, state))
        known = index < len(self.states) and self.states[index] == state
        return index if known else int(self.cost.argmin())


def evaluate_emissions(
    likelihood: FrameLikelihood, features: StateFeatures, posed_cost: SingleArray | None = None
) -> FrameEmissions:
    """Find the states that explain a frame, each at its best place.

    Args:
        likelihood: The frame.
        features: The states.
        posed_cost: (N H,) cost of each state's difference from a posed keyframe; None where none is posed.
    """
    first = np.arange(features.vectors.shape[1])
    if len(likelihood.visible) > len(likelihood.unclipped):  # with keypoints, too many for all variants
        plain = _variant_costs(likelihood, features.vectors, posed_cost, slice(0, 1))[0]
        first = lowest(plain, 4 * MOST_STATES, PRUNING_COST + EXTENT_COST + VARIANT_COST)
        posed_cost = None if posed_cost is None else posed_cost[first]
    vectors = features.vectors if len(first) == features.vectors.shape[1] else features.vectors[:, first]
    variant_cost = _variant_costs(likelihood, vectors, posed_cost, slice(None))
    cost = variant_cost.min(axis=0)
    kept = lowest(cost, 2 * MOST_STATES, PRUNING_COST + EXTENT_COST)
    cost, variant = cost[kept], variant_cost[:, kept].argmin(axis=0)
    states, vectors = first[kept], vectors[:, kept]
    hips = np.empty((3, len(states)), dtype=np.float32)
    for index, hips_map in enumerate(likelihood.hips_map.astype(np.float32)):
        own = variant == index
        hips[:, own] = hips_map @ vectors[:, own]
    backward = likelihood.backward.astype(np.float32)
    hips_depth = np.float32(likelihood.backward @ likelihood.location) - backward @ hips
    for marker in np.flatnonzero(likelihood.unclipped):
        centroid = vectors[3 * marker : 3 * marker + 3]
        depth = np.maximum(hips_depth - backward @ centroid, np.float32(0.1))
        cost += student_cost(
            _extent_error(likelihood, features.second_moment[marker][:, states], marker, depth), 3
        )
    if likelihood.visible.any():  # else the hips' place is unknown
        cost[hips_depth < 0.3] += np.float32(1e3)
    kept = lowest(cost, MOST_STATES, PRUNING_COST)
    ground = hips[:, kept]
    ground[2] -= vectors[-2, kept]
    return FrameEmissions(states[kept], cost[kept], hips[:, kept], ground, np.zeros(len(kept), dtype=bool))


def with_exchanged(plain: FrameEmissions, exchanged: FrameEmissions) -> FrameEmissions:
    """The likelier hypothesis for each state: keypoints as they are, or with left and right exchanged."""
    count = len(plain.states)
    states = np.concatenate([plain.states, exchanged.states])
    cost = np.concatenate([plain.cost, exchanged.cost + EXCHANGED_COST])
    order = np.lexsort((cost, states))
    _, first = np.unique(states[order], return_index=True)
    best = order[first]
    best = best[lowest(cost[best], MOST_STATES, PRUNING_COST)]
    hips = np.concatenate([plain.hips, exchanged.hips], axis=1)
    ground = np.concatenate([plain.ground, exchanged.ground], axis=1)
    return FrameEmissions(states[best], cost[best], hips[:, best], ground[:, best], best >= count)


def _variant_costs(
    likelihood: FrameLikelihood, vectors: SingleArray, posed_cost: SingleArray | None, variants: slice
) -> SingleArray:
    """Costs (V, S) of some states in some variants, without the markers' extents.

    Args:
        likelihood: The frame.
        vectors: (3 A + 2, S) the states' features.
        posed_cost: (S,) as in `evaluate_emissions`.
        variants: Which variants.
    """
    residual = likelihood.residual_map[variants].astype(np.float32) @ vectors  # (V, 2 A + G + 4, S)
    residual *= residual
    share = np.float32(likelihood.share)
    cost = student_cost(residual[:, -1], 1) + np.float32(likelihood.normalization)
    for point in np.flatnonzero(likelihood.visible):
        cost += share * student_cost(residual[:, 2 * point] + residual[:, 2 * point + 1], 2)
    for guess in np.flatnonzero(likelihood.depth_weight):
        cost += share * student_cost(residual[:, 2 * len(likelihood.visible) + guess], 1)
    if posed_cost is not None:
        cost += student_cost(residual[:, -4:-1].sum(axis=1), 3) + posed_cost
    return cost


def lowest(cost: SingleArray, count: int, margin: float) -> IndexArray:
    """Indices of the lowest costs within a margin of the least, at most `count`, in order of index."""
    kept = np.flatnonzero(cost <= cost.min() + np.float32(margin))
    if len(kept) > count:
        kept = np.sort(kept[np.argpartition(cost[kept], count)[:count]])
    return kept


def _extent_error(
    likelihood: FrameLikelihood, second_moment: SingleArray, marker: int, depth: SingleArray
) -> SingleArray:
    """Squared difference of the observed and predicted extents, in standard deviations."""
    a, b = likelihood.image_axes[marker]
    product = [(a, a), (a, b), (b, b)]
    rows = np.array([_products(u, v) for u, v in product], dtype=np.float32)
    predicted = square_root(*(rows @ second_moment))
    observed = likelihood.extent[marker].astype(np.float32)
    variance = (
        np.float32(likelihood.extent_std_m[marker] ** 2) + (np.float32(likelihood.pixel_size) * depth) ** 2
    )
    squared = sum(
        (predicted[k] - observed[k] * depth) ** 2 * np.float32(2.0 if k == 1 else 1.0) for k in range(3)
    )
    return np.asarray(squared / variance)


def _products(u: Array, v: Array) -> list[float]:
    """Coefficients of a symmetric matrix's six entries in uᵀ S v."""
    return [
        u[0] * v[0],
        u[1] * v[1],
        u[2] * v[2],
        u[0] * v[1] + u[1] * v[0],
        u[0] * v[2] + u[2] * v[0],
        u[1] * v[2] + u[2] * v[1],
    ]
