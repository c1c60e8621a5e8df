"""What keyframes nearby tell of a frame: one more hypothesis, and a cost of all others."""

import numpy as np

from ..arrays import Array
from ..body.posture import Posture
from ..estimate.single_frame import FrameFit, fit_frame
from ..prior.frame_prior import FramePrior, unrelated_std
from .frame_search import Hypotheses, Knowledge, refined
from .frame_shown import FrameShown

TOGETHER = 0.5
"""Share of the degrees of freedom that vary on their own: a body's change together."""


def belief_costs(belief: FramePrior, posture: Posture) -> Array:
    """(S,) cost of postures beside keyframes: Gaussian near them, bounded by what tells them from others.

    Far from all keyframes their belief is as wide as that of unrelated postures, and the cost vanishes.
    """
    deviation = posture.minus(Posture.stack([belief.posture])) / belief.std
    told = np.log(np.maximum(unrelated_std(posture.skeleton) / belief.std, 1.0)).sum()
    return np.asarray(TOGETHER * np.minimum(0.5 * (deviation**2).sum(axis=-1), told))


def believed_fit(
    known: Knowledge, shown: FrameShown, belief: FramePrior, floor_m: float | None
) -> tuple[FrameFit, float]:
    """The posture nearest to what keyframes tell that explains the frame, and its cost among hypotheses."""
    points = shown.points_of(False)
    fit = fit_frame(shown.evidence, shown.regions, belief, shown.frame, points=points)
    sides = np.array([False] if points is None else [False, True])
    postures = Posture.stack([fit.posture] * len(sides))
    nothing = np.zeros(len(sides))
    alone = Hypotheses(postures, nothing, nothing.astype(np.intp), sides)
    cost = refined(known, shown, alone, floor_m).cost.min()
    return fit, float(cost + belief_costs(belief, postures[:1])[0])
