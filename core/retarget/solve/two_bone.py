"""Two-bone inverse kinematics: a limb's joints for a goal of its end, and how far a limb stretches.

The limb bends in the plane of its own hinge, whose axis the performer's limb has at every moment, straight or
bent: no direction is guessed from a nearly straight limb, so that nothing flips.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...body import rotations
from ...numerics.vectors import unit

ARM_SOFT, LEG_SOFT = 0.97, 0.988  # shares of its length from which a limb resists being stretched further
STRAIGHTEST = 0.9999  # largest share of its length that a limb is extended: beyond, nothing bends
LEAST_M = 1e-6


@dataclass(frozen=True, eq=False)
class LimbPose:
    """The two long bones of a limb over F frames."""

    upper_turn: Array  # (F, 3, 3) turn of the upper bone from its aligned rest
    lower_turn: Array  # (F, 3, 3)
    start: Array  # (F, 3) hip or shoulder joint [m]
    middle: Array  # (F, 3) knee or elbow [m]
    end: Array  # (F, 3) ankle or wrist [m]
    hinge: Array  # (F, 3) unit axis about which it bends

    @property
    def extension_m(self) -> Array:
        """(F,) distance of its ends [m]."""
        return np.asarray(np.linalg.norm(self.end - self.start, axis=-1))

    @property
    def lengths_m(self) -> tuple[float, float]:
        """Lengths of the upper and the lower bone [m]."""
        ways = (self.middle - self.start, self.end - self.middle)
        upper_m, lower_m = (float(np.median(np.linalg.norm(way, axis=-1))) for way in ways)
        return upper_m, lower_m

    @property
    def straightness(self) -> Array:
        """(F,) how much it bends for a little way: a weight, large where it is nearly straight."""
        # What a leg is longer than the way between its ends, as a share, when it counts as nearly straight.
        return np.asarray(1.0 / (0.01 + np.maximum(1.0 - self.extension_m / sum(self.lengths_m), 0.0)))

    @property
    def bend(self) -> Array:
        """(F, 3) unit direction from the line through its ends toward knee or elbow, bent or straight."""
        line = unit(self.end - self.start)
        across = self.hinge - np.sum(self.hinge * line, axis=-1, keepdims=True) * line
        return unit(rotations.cross(line, across))


def stretched_m(wanted_m: Array, own_m: Array, length_m: float, soft: float = ARM_SOFT) -> Array:
    """(F,) extension that a limb takes on for a goal, smooth where the goal goes out of reach [m].

    From the share `soft` of its length it resists; its own extension (F,) without a goal is always allowed.
    """
    limit = STRAIGHTEST * length_m
    free = soft * limit
    room = limit - free
    resisted = limit - room * np.exp(-np.maximum(wanted_m - free, 0.0) / room)
    softly = np.where(wanted_m > free, resisted, wanted_m)
    return np.asarray(np.maximum(softly, np.minimum(np.minimum(wanted_m, own_m), limit)))


def reach_for(limb: LimbPose, start: Array, goal: Array, soft: float = ARM_SOFT) -> LimbPose:
    """The limb from where its hip or shoulder is now (F, 3), its end at a goal or as near as it stretches.

    It resists from the share `soft` of its length.
    """
    upper_m, lower_m = limb.lengths_m
    way = goal - start
    wanted_m = np.linalg.norm(way, axis=-1)
    distance = stretched_m(wanted_m, limb.extension_m, upper_m + lower_m, soft)
    distance = np.maximum(distance, abs(upper_m - lower_m) + 1e-6)
    old = unit(limb.end - limb.start)
    line = np.where(wanted_m[:, None] > 1e-6, unit(way), old)
    # The hinge is turned as the line through the ends is, and across it again.
    turned = (rotations.smallest(old, line) @ limb.hinge[..., None])[..., 0]
    hinge = unit(turned - np.sum(turned * line, axis=-1, keepdims=True) * line)
    out = rotations.cross(line, hinge)
    along = (upper_m**2 - lower_m**2 + distance**2) / (2.0 * distance)
    aside = np.sqrt(np.maximum(upper_m**2 - along**2, 0.0))
    middle = start + along[:, None] * line + aside[:, None] * out
    end = start + distance[:, None] * line
    return LimbPose(
        _redirected(limb.upper_turn, limb.middle - limb.start, limb.hinge, middle - start, hinge),
        _redirected(limb.lower_turn, limb.end - limb.middle, limb.hinge, end - middle, hinge),
        start,
        middle,
        end,
        hinge,
    )


def _redirected(turn: Array, old: Array, old_hinge: Array, new: Array, new_hinge: Array) -> Array:
    """Turns of a bone whose direction and hinge became others."""
    axes = []  # (F, 3, 3) as columns: along the bone, about it, across both
    for direction, hinge in ((old, old_hinge), (new, new_hinge)):
        along = unit(direction)
        about = unit(hinge - np.sum(hinge * along, axis=-1, keepdims=True) * along)
        axes.append(np.stack([along, about, rotations.cross(along, about)], axis=-1))
    return np.asarray(axes[1] @ np.swapaxes(axes[0], -1, -2) @ turn)
