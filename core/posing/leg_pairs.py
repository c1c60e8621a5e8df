"""Two legs on a stance: which of them stands on the floor, and whether the body is balanced over that.

This is all that ties one limb to another: of each leg the likeliest parts are paired.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import IndexArray, SingleArray
from ..estimate.terms.contact import STEP_M
from ..numerics.robust import multivariate_cost
from .match_evidence import student_cost

NO_CONTACT_COST = np.float32(4.0)  # where neither foot stands: jumps, steps, furniture


@dataclass(frozen=True, eq=False)
class LegChoices:
    """C parts of one leg for each of N stances."""

    index: IndexArray  # (N, C) which parts
    cost: SingleArray  # (N, C) of what is seen of them, and of feet below the floor
    height: SingleArray  # (N, C) of the foot above the floor [m]
    foot: SingleArray  # (N, C, 2) where the foot is, from the hips [m]
    mass: SingleArray  # (N, C, 2) what the leg adds to the center of mass, from the hips [m]


def likeliest(table: SingleArray, height: SingleArray) -> IndexArray:
    """(N, C) the parts of a leg to pair, by costs and heights (N, L)."""
    # Parts of each leg that are paired: so many of the likeliest, and of the likeliest that stand.
    count = min(12, table.shape[1])
    free = np.argpartition(table, count - 1, axis=1)[:, :count]
    standing = np.argpartition(table + standing_cost(height), count - 1, axis=1)[:, :count]
    return np.asarray(np.concatenate([free, standing], axis=1))


def pair_costs(left: LegChoices, right: LegChoices, mass: SingleArray) -> SingleArray:
    """(N, C, C) cost of each pair beyond the legs' own: that neither stands, or that the body falls.

    `mass` (N, 2) is the center of mass without the legs' shares, times the rest's share, from the hips [m].
    """
    center = mass[:, None, None] + left.mass[:, :, None] + right.mass[:, None]
    first = left.foot[:, :, None]
    way = right.foot[:, None] - first
    along = ((center - first) * way).sum(axis=-1) / np.maximum((way * way).sum(axis=-1), np.float32(1e-4))
    higher = right.height[:, None] - left.height[:, :, None]
    along = np.where(higher > STEP_M, 0.0, np.where(higher < -STEP_M, 1.0, np.clip(along, 0.0, 1.0)))
    off = center - first - along[..., None].astype(np.float32) * way
    # Horizontal distance of the center of mass from the feet that stand: a foot's length, a step under way.
    squared = (off * off).sum(axis=-1) / np.float32(0.12**2)
    # Of Student's t: who runs, leaps or leans on something is forgiven.
    falling = multivariate_cost(squared, 3.0, 2)
    stands = standing_cost(np.minimum(left.height[:, :, None], right.height[:, None])) + falling
    return np.asarray(np.minimum(stands, NO_CONTACT_COST))


def below_cost(height: SingleArray) -> SingleArray:
    """Cost of feet below the floor."""
    return _floor_cost(np.minimum(height, 0.0))


def standing_cost(height: SingleArray) -> SingleArray:
    """Cost of feet above the floor that should stand on it."""
    # A heel that is off the floor by this much is nothing unusual.
    return _floor_cost(np.maximum(height - np.float32(0.05), 0.0))


def _floor_cost(height: SingleArray) -> SingleArray:
    # Height of an ankle over a foot that stands: shoes are not measured, nor the floor's last centimeters.
    off = height / np.float32(0.05)
    return student_cost(off * off, 1)
