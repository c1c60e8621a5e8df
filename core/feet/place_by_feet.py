"""Where a body goes by its feet: what carries it stands, and the hips move as the standing foot says.

A network guesses the posture well and the place badly: its hips drift and its feet slide by centimeters
a frame. Of each foot and pair of frames the travel over the ground is zero, with an error of heavy tails:
a foot that swings is far off and counts for nothing. Solved by reweighting, from wide errors to narrow
ones, beside the place that was given.
"""

import numpy as np
from scipy.linalg import solveh_banded

from ..arrays import Array, IndexArray
from ..numerics.robust import student_weight
from ..numerics.vectors import weighted_median

LOW_M = 0.06  # height above the lower foot up to which one may stand; a step of stairs is three times as high
STANDING_M_S = 0.12  # usual speed of an ankle that stands, which rolls over its foot
WIDTHS = (8.0, 4.0, 2.0, 1.0, 1.0, 1.0)
"""Factors of it, from wide to narrow: first all that moves slowly stands."""
DEGREES = 1.0  # of Student's t of what a foot travels: most frames have a foot that swings
BEND_M_S2 = 4.0  # usual acceleration of the hips
GIVEN_S = 0.5  # time over which the given place is believed in its changes
EXACT_M = 1e-4  # how far the hips may move in frames in which their place is exact
FLOOR_M = 0.02  # spread of the heights in which feet stand on a level floor


def place_by_feet(
    hips: Array, feet: Array, rate: float, given_m: float, exact: IndexArray | None = None
) -> Array:
    """The hips' places (F, 3) [m] by feet (F, 2, 3) relative to them.

    `given_m` is the usual error of the places given (F, 3); infinite where none are. Those of the `exact`
    frames stay.
    """
    pins = np.zeros(0, dtype=np.intp) if exact is None else exact
    height = feet[..., 2] - feet[..., 2].min(axis=1, keepdims=True)
    low = np.maximum(height[1:], height[:-1])
    may_stand = 1.0 / (1.0 + (low / LOW_M) ** 4)  # (F-1, 2)
    step = np.diff(feet, axis=0)  # (F-1, 2, 3)
    place = np.array(hips)
    std = STANDING_M_S / rate
    for width in WIDTHS:
        travel = np.diff(place, axis=0)[:, None] + step
        squared = (travel**2).sum(axis=-1) / (width * std) ** 2
        weight = may_stand * student_weight(squared, DEGREES, 1) / (width * std) ** 2
        lowest = _floor_m(place, feet, weight)
        for axis in range(3):
            band, right = _beliefs(hips[:, axis], rate, given_m)
            band[0, pins] += EXACT_M**-2
            right[pins] += EXACT_M**-2 * hips[pins, axis]
            total, wanted = weight.sum(axis=1), -(weight * step[..., axis]).sum(axis=1)
            band[0, :-1] += total
            band[0, 1:] += total
            band[1, :-1] -= total
            right[:-1] -= wanted
            right[1:] += wanted
            if axis == 2:
                stands = np.zeros(feet.shape[:2])
                stands[1:] += weight
                stands[:-1] += weight
                stands *= (0.5 * (width * std) ** 2) / FLOOR_M**2
                off = place[:, None, 2] + feet[..., 2] - lowest
                stands *= student_weight((off / FLOOR_M) ** 2, DEGREES, 1)
                band[0] += stands.sum(axis=1)
                right += (stands * (lowest - feet[..., 2])).sum(axis=1)
            place[:, axis] = solveh_banded(band, right, lower=True, check_finite=False)
    return place


def _floor_m(place: Array, feet: Array, weight: Array) -> float:
    """Height on which most of the standing feet stand [m]."""
    heights = place[1:, None, 2] + feet[1:, :, 2]
    return weighted_median(heights.ravel(), weight.ravel())


def _beliefs(given: Array, rate: float, given_m: float) -> tuple[Array, Array]:
    """Band and right-hand side of the place given and of a steady way."""
    frames = len(given)
    band = np.zeros((3, frames))
    bend = (BEND_M_S2 / rate**2) ** -2
    if frames > 2:
        band[0, :-2] += bend
        band[0, 1:-1] += 4.0 * bend
        band[0, 2:] += bend
        band[1, :-2] -= 2.0 * bend
        band[1, 1:-1] -= 2.0 * bend
        band[2, :-2] += bend
    keep = np.exp(-1.0 / (rate * GIVEN_S))
    std = given_m if np.isfinite(given_m) else 1e3
    fresh = (1.0 - keep**2) * std**2
    own = np.full(frames, (1.0 + keep**2) / fresh)
    own[[0, -1]] = 1.0 / fresh
    beside = np.full(frames, -keep / fresh)
    band[0] += own
    band[1, :-1] += beside[:-1]
    right = own * given
    right[:-1] += beside[:-1] * given[1:]
    right[1:] += beside[:-1] * given[:-1]
    return band, right
