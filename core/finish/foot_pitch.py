"""A foot as a rigid sole under an ankle: the pitches that keep it above the ground and within its range.

A foot's orientation is taken apart as Rz(heading) Ry(roll) Rx(pitch) of the standing foot; a positive pitch
points the toes down. All functions broadcast over any leading axes; the last one is left and right.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.kinematics import Body
from ..body.soles import sole_offsets

TOES_UP_RAD = np.radians(40.0)
"""Dorsiflexion of a loaded ankle: about 40 degrees in a weight-bearing lunge (Bennell et al. 1998,
*Australian Journal of Physiotherapy* 44)."""
TOES_DOWN_RAD = np.radians(60.0)
"""Plantarflexion: 50 degrees (AAOS 1965, *Joint Motion*), widened as the joint limits of the body are."""
LEAST_CLEARANCE_M = 0.02
"""A foot that lies on its back or side is at least that thick."""


@dataclass(frozen=True, eq=False)
class Soles:
    """Heel and tip of both feet in their sagittal planes: distance from the ankle, and angle below level."""

    heel_m: Array
    """(2,) of the left and the right foot [m]."""
    heel_rad: Array
    """(2,) angle of the line from ankle to heel below the level one backward."""
    tip_m: Array
    tip_rad: Array

    @classmethod
    def of(cls, body: Body) -> "Soles":
        """The soles of a body."""
        heel, tip = np.moveaxis(sole_offsets(body), 1, 0)
        return cls(
            np.hypot(heel[:, 1], heel[:, 2]),
            np.arctan2(-heel[:, 2], heel[:, 1]),
            np.hypot(tip[:, 1], tip[:, 2]),
            np.arctan2(-tip[:, 2], -tip[:, 1]),
        )

    def depth_m(self, pitch_rad: Array, level: Array) -> Array:
        """Depth of the lower of heel and tip below the ankle [m].

        Args:
            pitch_rad: (..., 2) pitch.
            level: (..., 2) cosine of the roll.
        """
        heel = self.heel_m * np.sin(self.heel_rad - pitch_rad)
        tip = self.tip_m * np.sin(self.tip_rad + pitch_rad)
        return np.asarray(level * np.maximum(heel, tip))

    def clearance_m(self, shin_rad: Array) -> Array:
        """Least height of the ankle above the ground that the joint's range allows: a flat foot's, if it can.

        Args:
            shin_rad: (..., 2) pitch of the shin, and of a foot that is rigid with it.
        """
        low, high = shin_rad - TOES_UP_RAD, shin_rad + TOES_DOWN_RAD
        depths = [self.depth_m(pitch, np.ones(2)) for pitch in (np.clip(0.0, low, high), low, high)]
        return np.asarray(np.maximum(np.minimum.reduce(depths), LEAST_CLEARANCE_M))

    def above_ground(self, pitch_rad: Array, height_m: Array, level: Array, shin_rad: Array) -> Array:
        """The nearest pitch with neither heel nor tip below the ground.

        Args:
            pitch_rad: (..., 2) wanted pitch.
            height_m: (..., 2) height of the ankle above the ground.
            level: (..., 2) cosine of the roll.
            shin_rad: (..., 2) pitch of the shin; a foot that cannot be brought up in front goes behind.
        """
        reach = np.maximum(level, 1e-6)
        tip, heel = height_m / (reach * self.tip_m), height_m / (reach * self.heel_m)
        rise = np.arcsin(np.clip(tip, -1.0, 1.0))
        most = np.where(tip < 1.0, rise - self.tip_rad, np.inf)
        least = np.where(heel < 1.0, self.heel_rad - np.arcsin(np.clip(heel, -1.0, 1.0)), -np.inf)
        behind = np.pi - rise - self.tip_rad
        ahead = np.clip(pitch_rad, np.minimum(least, most), most)
        kneeling = shin_rad - TOES_UP_RAD > most
        return np.where(kneeling, np.maximum(pitch_rad, behind), ahead)

    def on_tiptoe(self, height_m: Array) -> Array:
        """(..., 2) pitch that puts the tip on the ground, the ankle being higher than above a flat foot."""
        return np.asarray(np.arcsin(np.clip(height_m / self.tip_m, -1.0, 1.0)) - self.tip_rad)
