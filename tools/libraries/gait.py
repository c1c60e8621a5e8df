"""Walking from footfalls: positions and times of the feet determine hips, trunk, arms and swinging legs.

Sources of the numbers: events, joint angles and the feet's roll: Perry & Burnfield (2010), *Gait Analysis*,
and Winter (2009), *Biomechanics and Motor Control of Human Movement*; excursions of the pelvis: Kadaba,
Ramakrishnan & Wootten (1990), Murray, Drought & Kory (1964); arms: Murray, Sepic & Barnard (1967).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import gaussian_filter1d, minimum_filter1d

from .moment import SIDES, Ankle, Arm, Foot, Moment, Turn, swung_arm
from .solving import BODY, ankle_of, hips_height

RATE_HZ = 100.0
STANCE = 0.61
"""Share of a cycle during which a foot is on the floor."""
LEADS = 0.25
"""Share of a cycle from the strike of a foot until the hips pass over it."""
HIPS_RISE_M = 0.065
"""The hips rise and fall by 4 to 5 cm at a usual speed, by 7 at a brisk one."""
PUSH_SHAPE, PUSH_DEG = 2.6, 64.0
SMOOTH_S, LOADING_S = 0.05, 0.06
SWING_PLACE = {0.0: 0.0, 0.12: 0.07, 0.5: 0.52, 0.8: 0.87, 0.92: 0.975, 1.0: 1.0}
"""Share of a swing's distance covered by the ankle, by share of its time."""
SWING_HEIGHT = {0.0: (1.0, 0.0, 0.0), 0.12: (1.0, 0.0, 0.04), 0.35: (0.7, 0.1, 0.055), 0.6: (0.1, 0.5, 0.02)}
SWING_HEIGHT |= {0.8: (0.0, 0.9, 0.012), 1.0: (0.0, 1.0, 0.0)}
"""An ankle's height by share of the swing: shares of its heights at toe off and at heel strike, and meters
for a stride of a meter and a half."""


_SWING_PLACE, _SWING_HEIGHT = (
    PchipInterpolator(list(keys), np.array(list(keys.values()), dtype=float), axis=0)
    for keys in (SWING_PLACE, SWING_HEIGHT)
)


@dataclass(frozen=True)
class Footfall:
    """A foot on the floor."""

    side: str
    strike_s: float
    lift_s: float
    x: float
    y: float
    turn: float = 0.0
    """Direction of the toes, to the left of -Y [degrees]."""
    heel: float = 1.0
    """Landing on the heel: 1 as in normal walking, 0 on the flat foot."""
    push: float = 1.0
    """Push-off with the toes: 1 as in normal walking."""


@dataclass(frozen=True)
class Style:
    """Parameters that differ between walkers; factors of 1 are normal walking."""

    arms: float = 1.0
    sway: float = 1.0
    """Sway of pelvis and chest."""
    bow: float = 2.0
    """Bow of the trunk, forward [degrees]."""
    apart_m: float = 0.045
    """Half the distance between the feet, side by side [m]."""
    aside: float = 6.0
    """Elevation of the arms from the trunk [degrees]."""
    lean: float = 0.0
    """Lean of the whole body to the left, as in a bend [degrees]."""
    elbow: float = 17.0
    """Least flexion of the elbows [degrees]."""
    bend: float = 6.6
    """Least flexion of a supporting knee [degrees]."""
    toes_out: float = 7.0
    """Outward turn of the feet [degrees]."""


@dataclass(frozen=True, eq=False)
class Walk:
    """A walk over footfalls in order of time, left and right alternating."""

    footfalls: Sequence[Footfall]
    step_s: float
    """Duration of a usual step, from one foot's strike to the other's."""
    style: Style = Style()
    body: Body = BODY

    def at(self, time_s: float) -> Moment:
        """The moment at a time."""
        x, y, pelvis, waist, neck = self._trunk(time_s)
        cycle, vigor = self._cycle(time_s)
        return Moment(
            x=x,
            y=y,
            height=float(np.interp(time_s, self.times, self._heights)),
            pelvis=pelvis,
            waist=waist,
            neck=neck,
            arms={"L": self._arm(cycle, vigor), "R": self._arm(cycle + np.pi, vigor)},
            legs={side: self._foot(side, time_s) for side in SIDES},
        )

    def _cycle(self, time_s: float) -> tuple[float, float]:
        """The phase [rad], 0 where the left heel strikes, and the vigor of the walk."""
        vigor = np.interp(time_s, self.times, self._vigor)
        return float(2.0 * np.pi * self._phases(time_s)), float(vigor)

    def _trunk(self, time_s: float) -> tuple[float, float, Turn, Turn, Turn]:
        """The hips' position over the floor [m], and the rotations of pelvis, chest and head."""
        cycle, vigor = self._cycle(time_s)
        x, y, heading = (float(np.interp(time_s, self.times, values)) for values in self._hips.T)
        sway, bow, facing = vigor * self.style.sway, self.style.bow, np.radians(heading)
        aside = 0.02 * sway * np.cos(cycle - 0.6 * np.pi)
        twist, drop = 5.0 * sway * np.cos(cycle), 4.0 * sway * np.cos(cycle - 0.3 * np.pi)
        return (
            x + aside * float(np.cos(facing)),
            y + aside * float(np.sin(facing)),
            Turn(3.0 + sway * np.cos(2.0 * cycle), self.style.lean - drop, heading - twist),
            Turn(bow - 1.5 * sway * np.cos(2.0 * cycle - 0.4), 1.3 * drop, 2.0 * twist),
            Turn(-bow, -0.3 * drop, -0.9 * twist),
        )

    @cached_property
    def times(self) -> Array:
        """(T,) a fine grid over the walk [s]."""
        first = min(fall.strike_s for fall in self.footfalls)
        last = max(fall.lift_s for fall in self.footfalls)
        return np.linspace(first, last, round((last - first) * RATE_HZ) + 1)

    @cached_property
    def _phases(self) -> PchipInterpolator:
        """Phase [cycles]: whole at left heel strikes, half at right ones."""
        strikes = np.array([fall.strike_s for fall in self.footfalls])
        for i in range(1, len(strikes)):  # feet that stand side by side from the beginning
            strikes[i] = max(strikes[i], strikes[i - 1] + 0.5 * self.step_s)
        halves = np.arange(len(strikes)) * 0.5 + (0.0 if self.footfalls[0].side == "L" else 0.5)
        return PchipInterpolator(strikes, halves, extrapolate=True)

    @cached_property
    def _hips(self) -> Array:
        """(T, 3) the hips' midpoint x, y [m] and heading [degrees]: between the feet by their load."""
        weights, places = [], []
        for fall in self.footfalls:
            sign = 1.0 if fall.side == "L" else -1.0
            heading = fall.turn - sign * self.style.toes_out
            facing, aside = np.radians(heading), sign * self.style.apart_m
            places.append((fall.x - aside * np.cos(facing), fall.y - aside * np.sin(facing), heading))
            full = fall.strike_s + LEADS * 2.0 * self.step_s
            since = fall.lift_s - (STANCE - LEADS) * 2.0 * self.step_s
            rises = np.clip((self.times - full) / self.step_s + 1.0, 0.0, 1.0)
            weights.append(rises * np.clip((since - self.times) / self.step_s + 1.0, 0.0, 1.0))
        share = np.array(weights) / np.sum(weights, axis=0)
        return gaussian_filter1d(share.T @ np.array(places), 0.05 * RATE_HZ, axis=0, mode="nearest")

    @cached_property
    def _vigor(self) -> Array:
        """(T,) speed relative to 1.3 m/s, at most 1.3."""
        speed = np.linalg.norm(np.gradient(self._hips[:, :2], self.times, axis=0), axis=-1)
        vigor = gaussian_filter1d(np.clip(speed / 1.3, 0.0, 1.3), 0.1 * RATE_HZ, mode="nearest")
        return np.asarray(vigor)

    @cached_property
    def _heights(self) -> Array:
        """(T,) height of the hips [m]: as high as the supporting legs allow, smoothed against jolts."""
        allowed = np.empty(len(self.times))
        for i, time_s in enumerate(self.times):
            x, y, pelvis, _, _ = self._trunk(time_s)
            legs = {side: self._foot(side, time_s) for side in SIDES if self._covers(side, time_s)}
            allowed[i] = hips_height(Moment(x, y, bend=self.style.bend, pelvis=pelvis, legs=legs), self.body)
        lowest = minimum_filter1d(allowed, int(1.1 * RATE_HZ), mode="nearest")
        capped = np.minimum(allowed, lowest + HIPS_RISE_M)
        # Loading bends the knee: the hips keep sinking for a moment after heel strike.
        window = int(LOADING_S * RATE_HZ)
        sunk = minimum_filter1d(capped, window, mode="nearest", origin=(window - 1) // 2)
        smooth = gaussian_filter1d(sunk, SMOOTH_S * RATE_HZ, mode="nearest")
        return np.asarray(np.minimum(smooth, allowed))

    def _standing(self, fall: Footfall, time_s: float) -> Foot:
        """A foot on the floor: it lands on the heel, lies flat and leaves by the ball."""
        stance = fall.lift_s - fall.strike_s
        since, left = time_s - fall.strike_s, fall.lift_s - time_s
        landing = min(0.12 * stance, 0.10)
        leaving = min(0.45 * stance, 0.40)
        up = np.clip(1.0 - since / landing, 0.0, 1.0) ** 1.5
        down = np.clip(1.0 - left / leaving, 0.0, 1.0) ** PUSH_SHAPE
        pitch = -19.0 * fall.heel * up + PUSH_DEG * fall.push * down
        return Foot(fall.x, fall.y, fall.turn, float(pitch))

    def _covers(self, side: str, time_s: float) -> bool:
        own = [fall for fall in self.footfalls if fall.side == side]
        return own[0].strike_s <= time_s <= own[-1].lift_s

    def _foot(self, side: str, time_s: float) -> Foot | Ankle:
        own = [fall for fall in self.footfalls if fall.side == side]
        for fall in own:
            if fall.strike_s <= time_s <= fall.lift_s:
                return self._standing(fall, time_s)
        before, after = next(
            (first, second)
            for first, second in zip(own, own[1:], strict=False)
            if first.lift_s < time_s < second.strike_s
        )
        share = (time_s - before.lift_s) / (after.strike_s - before.lift_s)
        start = ankle_of(self._standing(before, before.lift_s), self.body)
        end = ankle_of(self._standing(after, after.strike_s), self.body)
        gone = float(_SWING_PLACE(share))
        high, low, extra = (float(v) for v in _SWING_HEIGHT(share))
        length = float(np.linalg.norm(end[:2] - start[:2]))
        place = start[:2] + gone * (end[:2] - start[:2])
        floor = 0.36 * self.body.actor.segments_m["foot.L"]
        height = (
            floor
            + high * (start[2] - floor)
            + low * (end[2] - floor)
            + extra * min(max(length / 1.2, 0.45), 1.0)
        )
        turn = before.turn + gone * (after.turn - before.turn)
        return Ankle(float(place[0]), float(place[1]), float(height), turn)

    def _arm(self, cycle: float, vigor: float) -> Arm:
        """The arm of the side whose heel strikes at 0, when the arm is back."""
        much = self.style.arms * vigor
        forward = -np.cos(cycle - 0.25)
        return swung_arm(
            float((-4.0 + 19.0 * forward) * much),
            self.style.aside,
            rotation=10.0,
            elbow=float(self.style.elbow + 13.0 * much * (1.0 + np.cos(cycle - 0.5 - np.pi))),
            pronation=20.0,
        )


def steady(stride_m: float, stride_s: float, style: Style = Style()) -> Walk:
    """Walking straight ahead along -Y; the left heel strikes at time 0 with the hips at y = 0."""
    falls = []
    for step in range(-4, 5):
        side, sign = ("L", 1.0) if step % 2 == 0 else ("R", -1.0)
        strike, ahead = 0.5 * step * stride_s, (0.5 * step + LEADS) * stride_m
        turn = sign * style.toes_out
        falls.append(Footfall(side, strike, strike + STANCE * stride_s, sign * style.apart_m, -ahead, turn))
    return Walk(falls, 0.5 * stride_s, style)
