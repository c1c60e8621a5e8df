"""Additional variance of limbs that neither markers, keypoints nor keyframes have observed for some time.

Between keyframes and what is visible the estimate's own covariance holds, since gaps are short. Where a
performer is out of the picture, or pictures are black, it would stay as if people moved little from the last
known posture; they do not, and within half a second may be anywhere in their reach.

With these values, chosen by hand on six takes whose second half was made black, 87 to 100 % of the errors in
seven others lie within 1.96 standard deviations (10 to 68 % without). Those who walk off are farther away
still: 47 to 68 % in three of the six.
"""

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.skeleton import Skeleton

GRACE_S = 0.25
"""Time for which the estimate's own covariance holds."""
TIME_CONSTANT_S = 0.35
"""Time constant at which a limb approaches the variance of anywhere in reach."""
TRUNK_STD_RAD, LIMB_STD_RAD = 0.15, 0.5
"""Standard deviation of joints anywhere in reach [rad]."""
WALKING_SPEED_M_PER_S = 0.5
"""Growth of the place's standard deviation along each axis: the performer may stand or walk."""
FARTHEST_M = 2.0


def unobserved_variance(
    skeleton: Skeleton,
    segments: tuple[str, ...],
    visible: BoolArray,
    keyframes: IndexArray,
    time_s: Array,
) -> Array:
    """(F, D) variance of postures beyond their covariance, where nothing observes them [m², rad²].

    Args:
        skeleton: The body's.
        segments: (M,) the segment each marker is bound to, or the joint each keypoint moves with; an unknown
            name counts for the trunk.
        visible: (F, M) whether each marker or keypoint is seen.
        keyframes: (K,) frames whose posture is known.
        time_s: (F,) time stamps.
    """
    trunk, *limbs = skeleton.limbs
    joint = {one.name: index for index, one in enumerate(skeleton.joints)}
    joint |= {segment.name: segment.joint for segment in skeleton.segments}
    first = {name: skeleton.dof_starts[index] for name, index in joint.items()}
    std = np.zeros((len(time_s), skeleton.dof_count))
    posed = np.zeros(len(time_s), dtype=bool)
    posed[keyframes] = True
    for part in (trunk, *limbs):
        own = [i for i, name in enumerate(segments) if first.get(name, int(trunk[0])) in part]
        # Anything visible also locates the trunk.
        observed = posed | (visible if part is trunk else visible[:, own]).any(axis=1)
        unknown = _unobserved_time_s(observed, time_s)
        std[:, part] = (
            -np.expm1(-unknown / TIME_CONSTANT_S) * (TRUNK_STD_RAD if part is trunk else LIMB_STD_RAD)
        )[:, None]
        if part is trunk:
            std[:, :3] = np.minimum(WALKING_SPEED_M_PER_S * unknown, FARTHEST_M)[:, None]
    return std**2


def _unobserved_time_s(observed: BoolArray, time_s: Array) -> Array:
    """(F,) time from the nearest observed frame beyond the grace [s]."""
    if not observed.any():
        return np.full(len(time_s), FARTHEST_M / WALKING_SPEED_M_PER_S)
    known = time_s[observed]
    after = np.searchsorted(known, time_s)
    gap = np.minimum(
        np.abs(time_s - known[np.minimum(after, len(known) - 1)]),
        np.abs(time_s - known[np.maximum(after - 1, 0)]),
    )
    return np.asarray(np.maximum(gap - GRACE_S, 0.0))
