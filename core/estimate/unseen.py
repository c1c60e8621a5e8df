"""How far a limb may be from where it was believed to be, once nothing has told of it for long.

Between keyframes and markers that are seen, the estimate's own covariance holds: what happens there is short.
Where a performer is out of the picture, or pictures are black, it would go on as if people moved little from
what was last known; they do not, and within half a second may be anywhere in their reach.
"""

import numpy as np
from numpy.typing import NDArray

from ..body.skeleton import Skeleton

Array = NDArray[np.float64]

GRACE_S = 0.25
"""Time for which the estimate's own covariance holds."""
REACHED_S = 0.35
"""Time in which two thirds of the way to anywhere are gone."""
STRAY = {"location": 0.12, "trunk": 0.15, "limb": 0.5}
"""Standard deviation of anywhere [m, rad]. In fourteen takes, a place in the world a second ago tells of the
trunk to 0.3 m, of elbows to 0.5, wrists to 0.7, knees to 0.3 and ankles to 0.35 (medians over the takes)."""


def unseen_variance(
    skeleton: Skeleton,
    segments: tuple[str, ...],
    visible: NDArray[np.bool_],
    keyframes: NDArray[np.intp],
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
        stray = np.full(len(part), STRAY["trunk" if part is trunk else "limb"])
        if part is trunk:
            stray[: len(skeleton.joints[0].components) - 3] = STRAY["location"]
        std[:, part] = _open(told, time_s)[:, None] * stray
    return std**2


def _open(told: NDArray[np.bool_], time_s: Array) -> Array:
    """(F,) how much is open, 0 where something tells of it, 1 long before or after."""
    if not told.any():
        return np.ones(len(time_s))
    known = time_s[told]
    after = np.searchsorted(known, time_s)
    gap = np.minimum(
        np.abs(time_s - known[np.minimum(after, len(known) - 1)]),
        np.abs(time_s - known[np.maximum(after - 1, 0)]),
    )
    return np.asarray(-np.expm1(-np.maximum(gap - GRACE_S, 0.0) / REACHED_S))
