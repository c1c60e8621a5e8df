"""How far a motion departs from the prior between keyframes, and what is believed of a single frame.

Where neighboring keyframes differ much, much happens between them, and it is made of the same movements: the
hip that swings forward bends the knee. The deviation's acceleration therefore has the size and, within each
limb, the correlations of the steps between keyframes, plus a natural amount for every joint.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.posture import Posture
from ..body.skeleton import Skeleton
from .keyframes import Keyframe, interpolate

REFERENCE_STEP_S = 1.0 / 30.0  # accelerations are stated as second differences at this step
NATURAL_SHARE = 0.2  # factor on every degree of freedom's natural deviation (`Skeleton.deviations`)
# Factors on the steps between keyframes over their squared duration, with and without correlations. A swing
# there and back within a gap, a half sine, accelerates by nearly ten times its size over that square.
CORRELATED_SHARE, INDEPENDENT_SHARE = 6.0, 2.5


def process_noise_factor(keyframes: Posture, time_s: Array, loose: Array | float = 1.0) -> Array:
    """Cholesky factor L (D, D) of the covariance L Lᵀ of the deviation's second differences.

    Lower triangular, zero between different limbs [m, rad per squared step of 1/30 s]. `loose` (D,): factors
    on natural deviations.
    """
    skeleton = keyframes.skeleton
    covariance = np.diag((NATURAL_SHARE * loose * skeleton.deviations) ** 2)
    if len(time_s) > 1:
        gap = np.diff(time_s)[:, None] / REFERENCE_STEP_S
        step = keyframes[1:].minus(keyframes[:-1]) / gap**2
        shared = step.T @ step / len(step)
        covariance += INDEPENDENT_SHARE**2 * np.diag(np.diag(shared))
        for limb in skeleton.limbs:
            block = np.ix_(limb, limb)
            covariance[block] += CORRELATED_SHARE**2 * shared[block]
    return np.asarray(np.linalg.cholesky(covariance))


# Standard deviation between postures of the same person at two unrelated moments [m, rad]: round numbers for
# lively motion. Head and joints that no marker shows stay nearer to what was posed.
UNRELATED_STD = {
    "pelvis.location": 0.40,
    "pelvis": 0.35,
    "waist": 0.30,
    "neck": 0.15,
    "girdle": 0.12,
    "shoulder": 0.60,
    "elbow": 0.60,
    "forearm": 0.15,
    "hip": 0.45,
    "knee": 0.60,
    "shin": 0.05,
}
SPEED_M_PER_S = 0.7  # a walking performer's hips also move away steadily, by this speed
ROUGH_POSE_SHARE = 0.5  # deviation of a pose roughly set, as a share of `UNRELATED_STD`


@dataclass(frozen=True, eq=False)
class FramePrior:
    """A Gaussian prior of a posture, with starting points for the search."""

    posture: Posture  # a single posture: the mean
    std: Array  # (D,) standard deviation of each degree of freedom, in the mean's tangent space [m, rad]
    starts: Posture  # a batch of postures to start the search from, the first of them `posture`
    grounded: Posture | None = None  # at least one of these stands on the ground; None: unknown


def difference_std(skeleton: Skeleton, time_s: float) -> Array:
    """(D,) standard deviation [m, rad] of the difference between postures a time apart."""
    share = 1.0 - np.exp(-abs(time_s) / 0.3)
    std = share * unrelated_std(skeleton)
    std[:3] = np.maximum(std[:3], SPEED_M_PER_S * abs(time_s))
    return np.maximum(std, 1e-3)


def prior_from_keyframes(keyframes: Sequence[Keyframe], index: int, fps: float) -> FramePrior:
    """Prior of a frame from the nearest keyframes before and after it.

    One at the frame itself counts only if there is no other.
    """
    elsewhere = [keyframe for keyframe in keyframes if keyframe.index != index] or list(keyframes)
    before = [keyframe for keyframe in elsewhere if keyframe.index <= index][-1:]
    after = [keyframe for keyframe in elsewhere if keyframe.index > index][:1]
    near = sorted(before + after, key=lambda keyframe: abs(keyframe.index - index))
    skeleton = near[0].posture.skeleton
    variances = [difference_std(skeleton, (keyframe.index - index) / fps) ** 2 for keyframe in near]
    postures = [keyframe.posture for keyframe in near]
    everyone = Posture.stack([keyframe.posture for keyframe in elsewhere])
    if len(near) == 1:
        postures = [_extrapolated(elsewhere, index)]
        return FramePrior(postures[0], np.sqrt(variances[0]), Posture.stack(postures), grounded=everyone)
    between = interpolate(tuple(elsewhere), index + 1)[index]
    # Both neighbors count as independent, the nearer one more.
    std = (1.0 / variances[0] + 1.0 / variances[1]) ** -0.5
    return FramePrior(between, std, Posture.stack([between, *postures]), grounded=everyone)


def _extrapolated(keyframes: Sequence[Keyframe], index: int) -> Posture:
    """Extrapolate the outermost keyframe to a frame beyond it, by the hips' velocity between the last two."""
    early = index < keyframes[0].index
    last, other = (keyframes[0], keyframes[1:2]) if early else (keyframes[-1], keyframes[-2:-1])
    if not other:
        return last.posture
    step = np.zeros(last.posture.skeleton.dof_count)
    time = (index - last.index) / (last.index - other[0].index)
    step[:2] = 0.5 * time * (last.posture.translation - other[0].posture.translation)[:2]
    return last.posture.plus(step)


def prior_from_pose(posture: Posture) -> FramePrior:
    """Prior from a pose that the animator has set roughly for the frame."""
    return FramePrior(posture, ROUGH_POSE_SHARE * unrelated_std(posture.skeleton), Posture.stack([posture]))


def unrelated_std(skeleton: Skeleton) -> Array:
    """(D,) standard deviation [m, rad] between postures of one person at two unrelated moments."""
    return np.array(
        [
            UNRELATED_STD["pelvis.location" if ".location" in name else name.split(".")[0]]
            for name in skeleton.dof_names
        ]
    )
