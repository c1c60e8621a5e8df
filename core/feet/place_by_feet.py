"""Where a body goes by its feet: what carries it stands, and the hips move as the standing foot says.

A network guesses the posture well and the place badly: its hips drift and its feet slide by centimeters
a frame. Of each foot and pair of frames the travel over the ground is zero, with an error of heavy tails:
a foot that swings is far off and counts for nothing. Solved by reweighting, from wide errors to narrow
ones, beside the place that was given.
"""

import numpy as np

from ..arrays import Array, IndexArray
from ..numerics.block_banded import BlockBanded
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
EVERY = slice(None)


def place_by_feet(
    hips: Array, feet: Array, rate: float, given_m: float, exact: IndexArray | None = None
) -> Array:
    """The hips' places (F, 3) [m] by feet (F, 2, 3) relative to them.

    `given_m` is the usual error of the places given (F, 3); infinite where none are. Those of the `exact`
    frames stay.
    """
    height = feet[..., 2] - feet[..., 2].min(axis=1, keepdims=True)
    low = np.maximum(height[1:], height[:-1])
    may_stand = 1.0 / (1.0 + (low / LOW_M) ** 4)  # (F-1, 2)
    step = np.diff(feet, axis=0)  # (F-1, 2, 3)
    beliefs = _near(len(hips), rate, given_m, exact)
    near = beliefs.multiply(hips)
    beliefs.add_combination(EVERY, (1.0, -2.0, 1.0), np.array((BEND_M_S2 / rate**2) ** -2))
    place = np.array(hips)
    for width in WIDTHS:
        variance = (width * STANDING_M_S / rate) ** 2
        travel = np.diff(place, axis=0)[:, None] + step
        weight = may_stand * student_weight((travel**2).sum(axis=-1) / variance, DEGREES, 1) / variance
        system, right = BlockBanded(*hips.shape), near.copy()
        system.add(beliefs)
        system.add_combination(EVERY, (-1.0, 1.0), weight.sum(axis=1)[:, None])
        pull = (weight[..., None] * step).sum(axis=1)
        right[:-1] += pull
        right[1:] -= pull
        # Most of what stands is on one height.
        heights = place[:, None, 2] + feet[..., 2]
        lowest = weighted_median(heights[1:].ravel(), weight.ravel())
        stands = np.zeros(feet.shape[:2])
        stands[1:] += weight
        stands[:-1] += weight
        stands *= 0.5 * variance / FLOOR_M**2
        stands *= student_weight(((heights - lowest) / FLOOR_M) ** 2, DEGREES, 1)
        system.diagonal[:, 2, 2] += stands.sum(axis=1)
        right[:, 2] += (stands * (lowest - feet[..., 2])).sum(axis=1)
        place = system.factorize().solve(right)
    return place


def _near(frames: int, rate: float, given_m: float, exact: IndexArray | None) -> BlockBanded:
    """How near the places are to those given: their error wanders, and is none in exact frames."""
    std = given_m if np.isfinite(given_m) else 1e3
    keep = np.exp(-1.0 / (rate * GIVEN_S))
    found = BlockBanded(frames, 3)
    found.add_combination(EVERY, (-keep, 1.0), np.array(1.0 / ((1.0 - keep**2) * std**2)))
    known = np.zeros((frames, 1))
    known[0] = std**-2
    known[exact if exact is not None else []] += EXACT_M**-2
    found.add_combination(EVERY, (1.0,), known)
    return found
