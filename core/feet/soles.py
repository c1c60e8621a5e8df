"""Shins and the rigid soles under them: the pitches that keep a foot above the ground and within its range.

The orientation of a shin or foot is taken apart as Rz(heading) Ry(roll) Rx(pitch) of the one at rest; a
positive pitch points the toes down. All arrays are of left and right on the axis after the frames.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.body_volume import sole_offsets
from ..body.kinematics import Body, Pose
from ..body.skeleton import SIDES
from .contacts import Contact
from .ground import Ground, find_ground

TOES_UP_RAD = np.radians(50.0)
"""Dorsiflexion of a loaded ankle: about 40 degrees in a lunge (Bennell et al. 1998, *Australian Journal of
Physiotherapy* 44), widened by a quarter as the joint limits of the body are."""
TOES_DOWN_RAD = np.radians(60.0)  # plantarflexion: 50 degrees (AAOS 1965, *Joint Motion*), widened likewise


@dataclass(frozen=True, eq=False)
class Shins:
    """Both shins in F frames."""

    heading: Array  # (F, 2) [rad]; `roll` and `pitch` likewise
    roll: Array
    pitch: Array
    ankle: Array  # (F, 2, 3) its lower end [m]

    @classmethod
    def of(cls, body: Body, pose: Pose) -> "Shins":
        """The shins of F poses."""
        feet = [next(s for s in body.skeleton.segments if s.name == f"foot.{side}") for side in SIDES]
        rotation = np.stack([pose.rotation[:, foot.joint] for foot in feet], axis=1)
        return cls(
            np.arctan2(rotation[..., 1, 0], rotation[..., 0, 0]),
            -np.arcsin(np.clip(rotation[..., 2, 0], -1.0, 1.0)),
            np.arctan2(rotation[..., 2, 1], rotation[..., 2, 2]),
            np.stack([pose.place(foot.joint, body.local(foot.start)) for foot in feet], axis=1),
        )

    @property
    def lowest_pitch(self) -> Array:
        """(F, 2) pitch of a foot whose toes are up as far as the ankle lets them."""
        return self.pitch - TOES_UP_RAD

    @property
    def highest_pitch(self) -> Array:
        """(F, 2) pitch of a foot whose toes are down as far as the ankle lets them."""
        return self.pitch + TOES_DOWN_RAD


@dataclass(frozen=True, eq=False)
class Soles:
    """Heel and tip of both feet in their sagittal planes: distance from the ankle, and angle below level."""

    heel_m: Array  # (2,) of the left and the right foot [m]
    heel_rad: Array  # (2,) angle of the line from ankle to heel below the level one backward
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

    @property
    def flat_m(self) -> Array:
        """(2,) height of an ankle above its flat sole [m]."""
        return self._depth_m(np.zeros(2))

    def clearance_m(self, shins: Shins) -> Array:
        """(F, 2) least height of an ankle above the ground: a flat foot's, if it can lie flat [m]."""
        low, high = shins.lowest_pitch, shins.highest_pitch
        depths = [self._depth_m(pitch) for pitch in (np.clip(0.0, low, high), low, high)]
        # A foot that lies on its back or side is at least that thick.
        return np.asarray(np.maximum(np.minimum.reduce(depths), 0.02))

    def above_ground(self, pitch: Array, height_m: Array, level: Array, shins: Shins) -> Array:
        """As `ahead`, but toes that the ankle cannot bring up in front of the shin go behind it."""
        _, most = self._range(height_m, level)
        # Behind, the tip is as steep as in front.
        behind = np.maximum(pitch, np.pi - most - 2.0 * self.tip_rad)
        return np.where(shins.lowest_pitch > most, behind, self.ahead(pitch, height_m, level))

    def ahead(self, pitch: Array, height_m: Array, level: Array) -> Array:
        """Nearest pitches (F, 2) [rad] with no heel or tip below the ground; `level` has cosines of rolls."""
        least, most = self._range(height_m, level)
        return np.clip(pitch, np.minimum(least, most), most)

    def on_toes(self, height_m: Array) -> Array:
        """(F, 2) pitches that put the tips on the ground, the ankles being higher than above flat feet."""
        return np.asarray(np.arcsin(np.clip(height_m / self.tip_m, -1.0, 1.0)) - self.tip_rad)

    def _range(self, height_m: Array, level: Array) -> tuple[Array, Array]:
        """(F, 2) pitches at which heel and tip touch the ground; infinite where they are too high to."""
        reach = np.maximum(level, 1e-6)
        tip, heel = height_m / (reach * self.tip_m), height_m / (reach * self.heel_m)
        least = np.where(heel < 1.0, self.heel_rad - np.arcsin(np.clip(heel, -1.0, 1.0)), -np.inf)
        most = np.where(tip < 1.0, np.arcsin(np.clip(tip, -1.0, 1.0)) - self.tip_rad, np.inf)
        return least, most

    def _depth_m(self, pitch: Array) -> Array:
        """(..., 2) depth of the lower of heel and tip below the ankle [m]."""
        heel = self.heel_m * np.sin(self.heel_rad - pitch)
        tip = self.tip_m * np.sin(self.tip_rad + pitch)
        return np.asarray(np.maximum(heel, tip))


def ground_of(body: Body, pose: Pose, time_s: Array, rests: Sequence[Contact]) -> Ground:
    """The ground under F poses, whose feet lie flat where they can."""
    shins, soles = Shins.of(body, pose), Soles.of(body)
    flat_m = float(soles.flat_m.mean())
    return find_ground(shins.ankle, soles.clearance_m(shins), flat_m, time_s, rests)
