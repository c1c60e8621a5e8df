"""How far a limb may be from where it was believed to be, once nothing has told of it for long.

Between keyframes and markers that are seen, the estimate's own covariance holds: what happens there is short.
Where a performer is out of the picture, or pictures are black, it would go on as if people moved little from
what was last known; they do not, and within half a second may be anywhere in their reach.

With these values, chosen by hand on six takes whose second half was made black, 87 to 100 % of the errors in
seven others lie within 1.96 standard deviations (10 to 68 % without). Those who walk off are farther away
still: 47 to 68 % in three of the six.
"""

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.skeleton import Skeleton

GRACE_S = 0.25
"""Time for which the estimate's own covariance holds."""
REACHED_S = 0.35
"""Time in which two thirds of the way to anywhere in reach are gone."""
TURNED, BENT = 0.15, 0.5
"""Standard deviation of the trunk's joints and of the limbs' anywhere in reach [rad]."""
WALKED_M_PER_S = 0.5
"""Of the place in the world, along each axis: nobody knows whether the performer stands or walks."""
FARTHEST_M = 2.0


def unseen_variance(
    skeleton: Skeleton,
    segments: tuple[str, ...],
    visible: BoolArray,
    keyframes: IndexArray,
    time_s: Array,
) -> Array:
    """What is open of postures (F, D), beyond their covariance, where nothing tells of them [m², rad²].

    Args:
        skeleton: The body's.
        segments: (M,) what each marker is bound to; a name that is no segment's counts for the trunk.
        visible: (F, M) whether each marker is seen.
        keyframes: (K,) frames whose posture is known.
        time_s: (F,) time stamps.
    """
    trunk, *limbs = skeleton.limbs
    joint = {segment.name: segment.joint for segment in skeleton.segments}
    first = {name: skeleton.dof_starts[index] for name, index in joint.items()}
    std = np.zeros((len(time_s), skeleton.dof_count))
    posed = np.zeros(len(time_s), dtype=bool)
    posed[keyframes] = True
    for part in (trunk, *limbs):
        own = [i for i, name in enumerate(segments) if first.get(name, int(trunk[0])) in part]
        # Where any marker is seen, the trunk it hangs on is not far.
        told = posed | (visible if part is trunk else visible[:, own]).any(axis=1)
        unknown = _since(told, time_s)
        std[:, part] = (-np.expm1(-unknown / REACHED_S) * (TURNED if part is trunk else BENT))[:, None]
        if part is trunk:
            std[:, :3] = np.minimum(WALKED_M_PER_S * unknown, FARTHEST_M)[:, None]
    return std**2


def _since(told: BoolArray, time_s: Array) -> Array:
    """(F,) time from the nearest frame of which something tells, beyond the grace [s]."""
    if not told.any():
        return np.full(len(time_s), FARTHEST_M / WALKED_M_PER_S)
    known = time_s[told]
    after = np.searchsorted(known, time_s)
    gap = np.minimum(
        np.abs(time_s - known[np.minimum(after, len(known) - 1)]),
        np.abs(time_s - known[np.maximum(after - 1, 0)]),
    )
    return np.asarray(np.maximum(gap - GRACE_S, 0.0))
