"""The performer on the character's stage: turned to face canonically, moved to where the character stands."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...body.kinematics import SegmentMotion
from ...body.posture import turn_headings_rad, yaw_rotation
from ...feet.ground import Ground


@dataclass(frozen=True, eq=False)
class Stage:
    """A performer, and the way from their world to the character's canonical space [m]."""

    source: SegmentMotion
    ground: Ground  # under the performer
    turn: Array  # (3, 3) from the world's axes to canonical ones, by where the performer faces at first
    under: Array  # (3,) the point of the performer's floor under the hips at the first frame [m]
    stand: Array  # (3,) the point of the floor under the resting character's hips, canonical [m]
    size: float  # the character's size: its legs' length over the performer's
    lift_m: float  # how much higher its ankles are over soles than a performer's of its size [m]

    def heights(self, heights_m: Array) -> Array:
        """Canonical heights (...) of world heights of the ground [m]."""
        return np.asarray(self.stand[2] + self.size * (heights_m - self.under[2]))


def find_stage(source: SegmentMotion, ground: Ground, stand: Array, leg_m: float, ankle_m: float) -> Stage:
    """The stage of a character that rests over a point (3,) of the floor, ankles `ankle_m` over soles [m]."""
    lengths = source.body.actor.segments_m
    own_m = 0.5 * sum(lengths[f"{part}.{side}"] for part in ("thigh", "shin") for side in "LR")
    size = leg_m / own_m
    hips = 0.5 * (source.start["thigh.L"][0] + source.start["thigh.R"][0])
    under = np.array([hips[0], hips[1], ground.height_m[0].min()])
    turn = yaw_rotation(-float(turn_headings_rad(source.turn["pelvis"][:1])[0]))
    return Stage(source, ground, turn, under, stand, size, ankle_m - size * ground.ankle_m)
