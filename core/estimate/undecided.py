"""Stretches in which another solution costs about as much: what is undecided widens the estimate's sigma.

The estimate's covariance is that of errors around the solution that was taken, and knows nothing of another
one elsewhere. Both together are a mixture of two normal distributions (Bishop 2006, *Pattern Recognition and
Machine Learning*, sec. 2.3.9), of which the one that was taken remains the estimate: the other's share times
the square of its distance is added to the covariance.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray
from .local_fits import Contest

TEMPERATURE = 10.0
"""Costs are divided by this where they weigh two solutions. Frames count as if each erred anew but for slow
biases; model and surface err alike for a third of a second, ten frames, so that ten say as much as one."""
LEAST_SHARE = 0.01
"""A solution of less probability adds nothing."""
LEAST_DISTANCE_M = 0.05
"""Solutions nowhere farther apart than this are the same."""


@dataclass(frozen=True, eq=False)
class Undecided:
    """A stretch of consecutive frames with another solution that the footage does not rule out."""

    frame: IndexArray
    """(F,) indices in the clip."""
    away_m: Array
    """(F, P, 3) from the principal points of the solution that was taken to those of the other [m]."""
    share: float
    """Probability of the other, 0 to 1."""

    @property
    def telling_frame(self) -> int:
        """The frame in which the two differ most: a keyframe there decides."""
        return int(self.frame[np.linalg.norm(self.away_m, axis=-1).mean(axis=-1).argmax()])

    def covariance(self) -> Array:
        """(F, P, 3, 3) what the other solution adds to the covariance of the principal points [m²]."""
        return np.asarray(self.share * self.away_m[..., :, None] * self.away_m[..., None, :])


def undecided(tried: Contest, taken: bool, first: int, last: int) -> Undecided | None:
    """What a contest leaves undecided; None where it is decided.

    Args:
        tried: The contest.
        taken: Whether the alternative was taken.
        first: The frame from which it is about.
        last: The last such frame.
    """
    ahead = tried.gain if taken else -tried.gain
    share = float(1.0 / (1.0 + np.exp(np.clip(ahead / TEMPERATURE, -50.0, 50.0))))
    state, other = tried.estimate.state, tried.other.state
    away = state.body.points(other.pose) - state.body.points(state.pose)
    within = (state.frame >= first) & (state.frame <= last)
    if share < LEAST_SHARE or np.linalg.norm(away[within], axis=-1).max() < LEAST_DISTANCE_M:
        return None
    return Undecided(state.frame[within], (-away if taken else away)[within], share)


def undecided_covariance(stretches: Iterable[Undecided], frames: int, points: int) -> Array:
    """(F, P, 3, 3) what all that is undecided adds to the covariance of a clip's principal points [m²]."""
    covariance = np.zeros((frames, points, 3, 3))
    for one in stretches:
        covariance[one.frame] += one.covariance()
    return covariance
