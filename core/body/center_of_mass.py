"""Center of mass of the body, by its principal points."""

import numpy as np

from ..arrays import Array
from .skeleton import Skeleton

MASS_SHARES = {
    "head": ((("head", 1.0),), 0.081),
    "trunk": ((("shoulder", 0.5), ("hip", 0.5)), 0.497),
    "upper_arm": ((("shoulder", 0.564), ("elbow", 0.436)), 0.056),
    "forearm": ((("elbow", 0.318), ("wrist", 0.682)), 0.044),
    "thigh": ((("hip", 0.567), ("knee", 0.433)), 0.2),
    "shin": ((("knee", 0.394), ("ankle", 0.606)), 0.122),
}
"""Where each segment's center of mass lies between principal points, and its share of the body's mass, both
sides together, hands and feet with the segments above them (Winter 2009, *Biomechanics and Motor Control of
Human Movement*, table 4.1)."""


def mass_weights(skeleton: Skeleton) -> Array:
    """(P,) weight of each principal point in the center of mass; they sum to 1."""
    names = skeleton.point_names
    weights = np.zeros(len(names))
    for points, share in MASS_SHARES.values():
        for stem, part in points:
            own = [index for index, name in enumerate(names) if name.partition(".")[0] == stem]
            weights[own] += share * part / len(own)
    return weights
