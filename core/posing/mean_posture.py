"""Means of composed postures: what the probable parts near the likeliest ones have in common.

The likeliest path takes one part of a pool a frame, some centimeters from the truth whatever the evidence. The
mean over the parts near it, by their probabilities, is nearer; parts of another kind, as on the other depth side,
do not enter.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.posture import Posture
from .composed_states import FrameStates
from .part_features import HEADINGS, StanceFeatures
from .part_pools import ARM, LIMBS, TORSO, PartPools, part_columns

NEAR_M = 0.15
"""Distance within which parts are called of the same kind: deviation of a Gaussian."""


def mean_postures(
    pools: PartPools,
    stances: StanceFeatures,
    states: Sequence[FrameStates],
    stance: IndexArray,
    hips: Array,
    limbs: IndexArray,
    state_posterior: Sequence[SingleArray],
    limb_posterior: dict[str, Array],
) -> Posture:
    heading = stances.heading_rad
    likeliest = pools.composed(
        stance // HEADINGS,
        {limb: limbs[:, column] for column, limb in enumerate(LIMBS)},
        heading[stance % HEADINGS],
        hips,
    )
    step = np.zeros((len(stance), likeliest.skeleton.dof_count))
    points = stances.features.points
    none = {limb: np.zeros(1, dtype=np.intp) for limb in LIMBS}
    torso_dofs = [0, 1, 2, *_dofs(likeliest, TORSO, "")]
    for row, (own, chance) in enumerate(zip(states, state_posterior, strict=True)):
        apart = np.linalg.norm(points[own.stance] - points[stance[row]], axis=-1).mean(axis=-1)
        away = np.linalg.norm(own.hips - hips[row], axis=-1)
        weight = chance * np.exp(-0.5 * (apart**2 + (0.5*away)**2) / NEAR_M**2)
        kept = np.flatnonzero(weight > 1e-3 * weight.max())
        if not len(kept):
            continue
        weight = weight[kept] / weight[kept].sum()
        of = pools.composed(
            own.stance[kept] // HEADINGS,
            {limb: np.zeros(len(kept), dtype=np.intp) for limb in LIMBS},
            heading[own.stance[kept] % HEADINGS],
            own.hips[kept].astype(float),
        )
        delta = of.minus(likeliest[np.full(len(kept), row)])
        step[row, torso_dofs] = (weight @ delta)[torso_dofs]
    for column, limb in enumerate(LIMBS):
        kind, side = limb.split(".")
        pool = pools.arms if kind == ARM else pools.legs
        shape = stances.limbs[limb].points
        dofs = _dofs(likeliest, kind, side)
        every = pools.composed(
            np.zeros(len(pool), dtype=np.intp),
            {one: np.arange(len(pool)) if one == limb else np.zeros(len(pool), dtype=np.intp) for one in LIMBS},
            np.zeros(len(pool)),
            np.zeros((len(pool), 3)),
        )
        for row, part in enumerate(limbs[:, column]):
            apart = np.linalg.norm(shape - shape[part], axis=-1).mean(axis=-1)
            weight = limb_posterior[limb][row] * np.exp(-0.5 * (apart / NEAR_M) ** 2)
            kept = np.flatnonzero(weight > 1e-3 * weight.max())
            weight = weight[kept] / weight[kept].sum()
            delta = every[kept].minus(every[np.full(len(kept), part)])
            step[row, dofs] = (weight @ delta)[dofs]
    return likeliest.plus(step)


def _dofs(posture: Posture, kind: str, side: str) -> list[int]:
    balls, hinges = part_columns(kind, side)
    skeleton = posture.skeleton
    return [*map(int, skeleton.ball_dofs[balls].ravel()), *map(int, skeleton.hinge_dofs[hinges])]
