"""Running: feet planted while they bear the body, free flight between, and legs that swing by their angles.

Numbers: Novacheck (1998), *The biomechanics of running*, Gait & Posture 7, for joints, stance and flight;
Hinrichs (1987), *Upper extremity function in running. II*, International Journal of Sport Biomechanics 3, for
the arms.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from .moment import SIDES, Ankle, Arm, Foot, Leg, Moment, Turn, swung_arm
from .solving import ankle_of, hips_height, pelvis_rotation, swinging_ankle

Array = NDArray[np.float64]
Keys = dict[float, float]

GRAVITY_MPS2 = 9.81


@dataclass(frozen=True)
class Pace:
    """Parameters of a run."""

    stride_m: float
    stride_s: float
    stance: float
    """Share of the cycle during which a foot is on the floor; less than half."""
    ahead_m: float
    """Distance of the ankle before the hips at landing [m]."""
    hip: Keys
    """Flexion of the hip by share of the swing, from toe off to strike [degrees]."""
    knee: Keys
    landing_deg: float
    """Flexion of the knee at landing."""
    bow: float
    """Bow of the trunk, forward [degrees]."""
    arms: float
    """Amplitude of the arms' swing from hanging [degrees]."""
    elbow: float = 88.0
    push_deg: float = 60.0
    """Pitch of the foot at toe off [degrees]."""
    toes_up: float = 8.0
    """Pitch of the foot at landing, on the heel [degrees]."""
    apart_m: float = 0.05
    """Half the distance between the feet, side by side [m]."""


@dataclass(frozen=True, eq=False)
class Run:
    """Running straight ahead along -Y; the left foot lands at phase 0 with the hips at y = 0."""

    pace: Pace

    def at(self, phase: float) -> Moment:
        """The moment at a phase of the cycle."""
        trunk = self._trunk(phase)
        cycle = 2.0 * np.pi * phase
        return Moment(
            x=trunk.x,
            y=trunk.y,
            height=trunk.height,
            pelvis=trunk.pelvis,
            waist=trunk.waist,
            neck=trunk.neck,
            arms={"L": self._arm(cycle), "R": self._arm(cycle + np.pi)},
            legs={side: self._leg(side, phase, trunk) for side in SIDES},
        )

    def _trunk(self, phase: float) -> Moment:
        cycle, much = 2.0 * np.pi * phase, self.pace.arms / 30.0
        drop = 4.0 * np.sin(cycle + 0.2)
        return Moment(
            x=0.010 * float(np.sin(cycle + 0.3)),
            y=-phase * self.pace.stride_m,
            height=self._height_landing + self._rise(phase),
            pelvis=Turn(0.7 * self.pace.bow, -drop, -5.0 * much * np.cos(cycle - 0.5)),
            waist=Turn(0.3 * self.pace.bow, 1.2 * drop, 16.0 * much * np.cos(cycle - 0.35)),
            neck=Turn(-0.7 * self.pace.bow, -0.2 * drop, -9.0 * much * np.cos(cycle - 0.35)),
        )

    def _rise(self, phase: float) -> float:
        """Height relative to that of landing [m]: a spring in stance, ballistic in flight."""
        since, stance = phase % 0.5, self.pace.stance
        flight_s = (0.5 - stance) * self.pace.stride_s
        speed = 0.5 * GRAVITY_MPS2 * flight_s
        if since < stance:
            deep = speed * stance * self.pace.stride_s / np.pi
            return -float(deep * np.sin(np.pi * since / stance))
        elapsed = (since - stance) * self.pace.stride_s
        return float(0.5 * GRAVITY_MPS2 * elapsed * (flight_s - elapsed))

    @cached_property
    def _height_landing(self) -> float:
        """Height of the hips at landing [m]."""
        foot = self._planted("L", 0.0, 0.0)
        bow = Turn(0.7 * self.pace.bow)
        return hips_height(Moment(bend=self.pace.landing_deg, pelvis=bow, legs={"L": foot}))

    def _planted(self, side: str, landed: float, share: float) -> Foot:
        """A foot on the floor since the phase `landed`, after a share of its stance."""
        sign = 1.0 if side == "L" else -1.0
        up = np.clip(1.0 - share / 0.15, 0.0, 1.0)
        down = np.clip((share - 0.45) / 0.55, 0.0, 1.0) ** 1.5
        pitch = -self.pace.toes_up * up + self.pace.push_deg * down
        place = -landed * self.pace.stride_m - self.pace.ahead_m
        return Foot(sign * self.pace.apart_m, place, sign * 6.0, float(pitch))

    def _leg(self, side: str, phase: float, trunk: Moment) -> Foot | Ankle:
        offset = 0.0 if side == "L" else 0.5
        landed = np.floor(phase - offset) + offset
        share = (phase - landed) / self.pace.stance
        if share <= 1.0 + 1e-9:
            return self._planted(side, landed, min(share, 1.0))
        left = landed + self.pace.stance
        swing = (phase - left) / (1.0 - self.pace.stance)
        free = self._free(side, swing, trunk)
        at_start = self._free(side, 0.0, self._trunk(left))
        at_end = self._free(side, 1.0, self._trunk(landed + 1.0))
        eased = swing**2 * (3.0 - 2.0 * swing)
        place = (
            free
            + (1.0 - eased) * (ankle_of(self._planted(side, landed, 1.0)) - at_start)
            + eased * (ankle_of(self._planted(side, landed + 1.0, 0.0)) - at_end)
        )
        return Ankle(*(float(value) for value in place), 6.0 if side == "L" else -6.0)

    def _free(self, side: str, swing: float, trunk: Moment) -> Array:
        """(3,) position of the ankle by angles alone [m]."""
        hip, knee = (_through(keys, swing) for keys in (self.pace.hip, self.pace.knee))
        hips = np.array([trunk.x, trunk.y, trunk.height])
        leg = Leg(flexion=hip, abduction=1.0, knee=knee)
        return swinging_ankle(side, leg, hips, pelvis_rotation(trunk))[0]

    def _arm(self, cycle: float) -> Arm:
        """The arm of the side whose foot lands at 0, when the arm is back."""
        forward = -float(np.cos(cycle - 0.25))
        return swung_arm(
            -5.0 + self.pace.arms * forward,
            15.0,
            rotation=29.0 + 10.0 * forward,
            elbow=self.pace.elbow + 12.0 * forward,
            pronation=20.0,
            girdle=2.0,
        )


def _through(keys: Keys, share: float) -> float:
    return float(CubicSpline(list(keys), list(keys.values()))(share))
