"""The paper's fuzzy reasoning: how the posture moves on, from how far the nearest keyframe is.

Two rules (paper, section 5), applied to every degree of freedom by itself:

* if the frame is *near* a keyframe, the step is like θ_p,t+1 - θ̂_t: back to the a priori posture;
* if it is *far* from one, the step is like θ_p,t+1 - θ_p,t: along with the a priori posture.

Each rule's output set is a triangle about its step. It is clipped at the rule's degree (Mamdani & Assilian
1975, *An experiment in linguistic synthesis with a fuzzy logic controller*), the sets are joined by maximum,
and mean and variance of the joined membership are the step's mean w̄ and process noise Q.

The paper's Figure 7, which draws the sets, is lost; the shapes here are ours.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array


@dataclass(frozen=True)
class Memberships:
    """The input sets, over the distance to the nearest keyframe in half gaps: 0 on it, 1 midway between two.

    *near* falls in a straight line from 1 at the keyframe to 0 at `near_ends`; *far* rises from 0 at
    `far_starts` to 1 at `far_full`.
    """

    near_ends: float = 1.0
    far_starts: float = 0.0
    far_full: float = 1.0

    def near(self, distance: ArrayLike) -> Array:
        """Degree (...) to which a distance (...) [half gaps] is near."""
        return np.asarray(np.clip(1.0 - np.asarray(distance, dtype=np.float64) / self.near_ends, 0.0, 1.0))

    def far(self, distance: ArrayLike) -> Array:
        """Degree (...) to which a distance (...) [half gaps] is far."""
        beyond = np.asarray(distance, dtype=np.float64) - self.far_starts
        return np.asarray(np.clip(beyond / (self.far_full - self.far_starts), 0.0, 1.0))


def keyframe_distance(frame_count: int, keyframes: ArrayLike) -> Array:
    """Distance of each frame from its nearest keyframe, relative to the gap it lies in.

    `keyframes` (K,) increase, K ≥ 1. (F,) in half gaps: 0 on a keyframe, 1 midway between two. Before the
    first and after the last keyframe the nearest gap is the measure, and 1 the most; with a single keyframe
    the clip's length is.
    """
    K = np.asarray(keyframes, dtype=np.float64)
    frame = np.arange(frame_count, dtype=np.float64)
    nearest = np.abs(frame[:, None] - K).min(axis=1)
    if len(K) < 2:
        return np.asarray(np.minimum(2.0 * nearest / max(frame_count, 1), 1.0))
    stretch = np.clip(np.searchsorted(K, frame, side="right") - 1, 0, len(K) - 2)
    return np.asarray(np.minimum(2.0 * nearest / np.diff(K)[stretch], 1.0))


@dataclass(frozen=True, eq=False)
class OutputSet:
    """A rule's output: triangles about `center` (D,) of half-width `width` (D,), clipped at `degree`."""

    center: Array
    width: Array
    degree: float

    def membership(self, value: Array) -> Array:
        """Clipped membership (N, D) of values (N, D)."""
        return np.asarray(np.clip(1.0 - np.abs(value - self.center) / self.width, 0.0, self.degree))

    @property
    def corners(self) -> Array:
        """(4, D) values at which the membership bends."""
        top = (1.0 - self.degree) * self.width
        return np.stack(
            [self.center - self.width, self.center - top, self.center + top, self.center + self.width]
        )


def aggregate(near: OutputSet, far: OutputSet) -> tuple[Array, Array]:
    """Mean and variance, (D,) each, of the maximum (OR) of two clipped output sets.

    The joined membership is a broken line; its moments are exact: on each straight piece Simpson's rule
    integrates membership times value squared, a cubic, without error.
    """
    # Values relative to the middle, so that the variance does not cancel when the centers are large.
    middle = 0.5 * (near.center + far.center)
    value = np.sort(np.concatenate([near.corners, far.corners]), axis=0)  # (8, D)
    value = np.sort(np.concatenate([value, _crossings(value, near, far)]), axis=0)  # (15, D)
    centers = 0.5 * (value[:-1] + value[1:])
    membership, at_center = _joined(value, near, far), _joined(centers, near, far)
    simpson = np.diff(value, axis=0) / 6.0
    moments = []
    for power in (0, 1, 2):
        ends, between = membership * (value - middle) ** power, at_center * (centers - middle) ** power
        moments.append(np.sum(simpson * (ends[:-1] + 4.0 * between + ends[1:]), axis=0))
    mean = moments[1] / moments[0]
    return middle + mean, np.maximum(moments[2] / moments[0] - mean**2, 0.0)


def _joined(value: Array, near: OutputSet, far: OutputSet) -> Array:
    return np.maximum(near.membership(value), far.membership(value))


def _crossings(value: Array, near: OutputSet, far: OutputSet) -> Array:
    """Where the memberships cross between neighboring values (N, D), or else their midpoint: (N - 1, D)."""
    difference = near.membership(value) - far.membership(value)
    before, after = difference[:-1], difference[1:]
    crossing = before * after < 0.0
    share = np.where(crossing, before / np.where(crossing, before - after, 1.0), 0.5)
    return np.asarray(value[:-1] + share * np.diff(value, axis=0))
