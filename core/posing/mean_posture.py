"""Means of composed postures: what the probable parts near the likeliest ones have in common.

The likeliest path takes one part of a pool a frame, some centimeters from the truth whatever is seen. The
mean of the parts near it, weighed by their probabilities, is nearer; parts of another kind, as those on the
other depth side, do not enter.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.limbs import LIMBS
from ..body.posture import Posture
from ..body.skeleton import Skeleton
from .composed_path import ComposedPath
from .composed_states import FrameStates
from .part_features import StanceFeatures, composed_postures
from .part_pools import TORSO, PartPools, part_columns

NEAR_M = 0.15
"""Parts within about this distance are of one kind: less than there is between a limb's depth sides."""
LEAST_SHARE = 1e-3
"""Parts that weigh less than this share of the weightiest are left out."""


def mean_postures(
    pools: PartPools, stances: StanceFeatures, states: Sequence[FrameStates], path: ComposedPath
) -> Posture:
    """(T,) means of the likely postures around a path.

    Args:
        pools: All parts.
        stances: Their stances.
        states: The T frames' states.
        path: The path through them.
    """
    likeliest = composed_postures(pools, stances, path.stance, path.limbs, path.hips)
    skeleton = likeliest.skeleton
    step = np.zeros((len(path.stance), skeleton.dof_count))
    torso = [0, 1, 2, *_dofs(skeleton, TORSO)]
    points = stances.features.points
    for row, (own, chance) in enumerate(zip(states, path.posterior, strict=True)):
        apart = np.linalg.norm(points[own.stance] - points[path.stance[row]], axis=-1).mean(axis=-1)
        kept, weight = _weights(chance, apart)
        near = own.chosen(kept)
        others = composed_postures(pools, stances, near.stance, near.limbs, near.hips)
        step[row, torso] = weight @ others.minus(likeliest[np.full(len(kept), row)])[:, torso]
    for limb, chosen in zip(LIMBS, path.limbs.T, strict=True):
        kind, _, side = limb.partition(".")
        dofs = _dofs(skeleton, kind, side)
        every = _alone(pools, limb, len(stances.limbs[limb].points))
        shapes = stances.limbs[limb].points
        for row, part in enumerate(chosen):
            apart = np.linalg.norm(shapes - shapes[part], axis=-1).mean(axis=-1)
            kept, weight = _weights(path.limb_posterior[limb][row], apart)
            step[row, dofs] = weight @ every[kept].minus(every[np.full(len(kept), part)])[:, dofs]
    return likeliest.plus(step)


def _weights(chance: Array | SingleArray, apart_m: Array | SingleArray) -> tuple[IndexArray, Array]:
    """Which of N parts count, by their probabilities and distances from the likeliest, and their weights."""
    near = np.exp(-0.5 * (apart_m / NEAR_M) ** 2)
    weight = np.asarray(chance, dtype=float) * near
    if not weight.any():  # all that is probable is far away
        weight = near
    kept = np.flatnonzero(weight >= LEAST_SHARE * weight.max())
    return kept, weight[kept] / weight[kept].sum()


def _alone(pools: PartPools, limb: str, count: int) -> Posture:
    """(count,) postures with each of a limb's parts, everything else alike."""
    none = np.zeros(count, dtype=np.intp)
    limbs = {other: np.arange(count) if other == limb else none for other in LIMBS}
    return pools.composed(none, limbs, np.zeros(count), np.zeros((count, 3)))


def _dofs(skeleton: Skeleton, kind: str, side: str = "") -> list[int]:
    """Degrees of freedom of a part."""
    balls, hinges = part_columns(kind, side)
    return [*map(int, skeleton.ball_dofs[balls].ravel()), *map(int, skeleton.hinge_dofs[hinges])]
