"""Turns between keyframes the other way round: the same keyframes, with whole turns about the vertical added.

Interpolation turns the body by at most half a turn between two keyframes. Whoever spins may have turned by
the rest of the circle the other way, or by a whole turn more; the keyframes alone do not say which.
"""

import numpy as np
from scipy.interpolate import PchipInterpolator

from ..arrays import Array, IndexArray
from ..body.heading import headings_rad, yawed_at
from ..body.posture import Posture

FULL_TURN = 2.0 * np.pi


def heading_steps_rad(posed: Posture) -> Array:
    """(K - 1,) turns from each of K postures to the next, the short way round, -π to π."""
    step = np.diff(headings_rad(posed))
    return np.asarray(step - FULL_TURN * np.round(step / FULL_TURN))


def with_turns(prior: Posture, keyframes: IndexArray, turns: IndexArray) -> Posture:
    """Interpolated postures with whole turns added between keyframes, spread smoothly.

    The heading is the monotone cubic (Fritsch & Carlson 1980) through the keyframes' headings unwound with
    these turns instead of without; leans and all else stay those of the interpolation, seen from the body.

    Args:
        prior: F postures that pass through the keyframes and turn the short way round.
        keyframes: (K,) their frames, increasing.
        turns: (K - 1,) turns added in each gap, counterclockwise seen from above; 0 for none.
    """
    if not turns.any():
        return prior
    wound = np.concatenate([[0.0], np.cumsum(heading_steps_rad(prior[keyframes]))])
    more = np.concatenate([[0.0], np.cumsum(FULL_TURN * turns)])
    frame = np.clip(np.arange(prior.batch[0]), keyframes[0], keyframes[-1])
    added = _monotone(keyframes, wound + more, frame) - _monotone(keyframes, wound, frame)
    # Whole turns are none: far from those added the interpolation stays as it is, to the last digit.
    added -= FULL_TURN * np.round(added / FULL_TURN)
    added[np.abs(added) < 1e-9] = 0.0
    turned = np.flatnonzero(added)
    if not len(turned):
        return prior
    changed = yawed_at(prior[turned], added[turned], prior.translation[turned])
    rotations = prior.rotations.copy()
    rotations[turned] = changed.rotations
    return Posture(prior.skeleton, prior.translation, rotations, prior.angles)


def _monotone(knots: IndexArray, values: Array, times: IndexArray) -> Array:
    return np.asarray(PchipInterpolator(knots.astype(np.float64), values)(times.astype(np.float64)))
