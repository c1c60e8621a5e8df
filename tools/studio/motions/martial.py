"""Fast punches in twos and threes, a lean away, a front kick off the rear leg, and two punches on landing."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, shock, sprung, sway
from ..limbs import FreeLeg
from ..performance import FPS, Choreography
from ..standing import arm, choreography, foot, free, stepped, tall_m

JABS_S, CROSS_S, HOOK_S = (0.36, 0.60), 0.82, 1.12
KICK_S, LANDED_S = 1.80, 2.22
LAST_S = (2.34, 2.56)
"""A cross with the left, which is now the rear arm, and a jab with the right."""
GUARD = {"elevation": 34, "forward": 52, "rotation": 22, "flexion": 124, "pronation": 20, "girdle": 4}
STRAIGHT = {"elevation": 88, "forward": 80, "rotation": 40, "flexion": 8, "pronation": 70, "girdle": 13}
HOOK = {"elevation": 86, "forward": 50, "rotation": 76, "flexion": 84, "pronation": 40, "girdle": 10}
DOWN = {"elevation": 24, "forward": -20, "rotation": 8, "flexion": 52, "pronation": 10, "girdle": 0}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    kick, landed = KICK_S, LANDED_S
    jabs = sum(_punch(times, at) for at in JABS_S)
    cross, hook = _punch(times, CROSS_S), burst(times, HOOK_S - 0.14, HOOK_S, HOOK_S + 0.24)
    last_left, last_right = (_punch(times, at) for at in LAST_S)
    away = burst(times, 1.18, 1.40, 1.62)
    thrown = burst(times, kick - 0.30, kick + 0.03, kick + 0.40)
    ring = shock(times, [0.34, landed])
    bounce = 0.010 * np.sin(2.0 * np.pi * times / 0.41 + 0.5)
    left = arm(
        times, GUARD, (jabs + last_left, STRAIGHT), (hook, HOOK), (0.35 * cross, DOWN), (0.5 * thrown, DOWN)
    )
    right = arm(times, GUARD, (cross + last_right, STRAIGHT), (0.9 * thrown, DOWN), (0.3 * hook, DOWN))
    for channels in (left, right):
        for name, values in channels.items():
            channels[name] = sprung(values, times, 6.5, 0.75)
    quick = cross + 0.5 * last_right - 0.6 * last_left
    pelvis = {
        "x": driven({0.0: 0.0, 0.3: 0.02, 1.1: 0.03, 1.4: 0.0, kick - 0.1: 0.06, landed: 0.0,
                     2.9: 0.0}, times, 3.2),
        "y": driven({0.0: 0.10, 0.36: -0.02, CROSS_S: -0.10, HOOK_S: -0.08, 1.40: 0.06, kick - 0.25: -0.10,
                     kick: -0.27, landed: -0.34, LAST_S[1]: -0.44, 2.95: -0.36}, times, 3.5, 0.75),
        "z": tall_m(body) + bounce - 0.012 * ring - driven(
            {0.0: 0.08, 0.8: 0.10, 1.1: 0.12, 1.4: 0.09, kick - 0.2: 0.035, kick: 0.03, kick + 0.2: 0.06,
             landed + 0.06: 0.14, 2.6: 0.10, 3.0: 0.085}, times, 4.5, 0.7),
        "yaw": -36.0 + sprung(28.0 * cross - 8.0 * jabs - 30.0 * hook, times, 6.5, 0.62) + driven(
            {1.4: 0, kick - 0.28: 16, kick: 50, kick + 0.25: 50, landed: 66, 2.9: 70}, times)
            - sprung(20.0 * last_left - 14.0 * last_right, times, 6.5, 0.62),
        "pitch": 4.0 + sprung(-7.0 * away, times, 4.5, 0.7) + driven(
            {1.4: 0, kick - 0.15: -6, kick: -18, kick + 0.2: -8, landed + 0.06: 6, 2.7: 0}, times),
        "roll": sprung(4.0 * hook - 4.0 * away, times, 5.0, 0.7),
    }  # fmt: skip
    trunk = {
        "pitch": 9.0 + sprung(-20.0 * away + 4.0 * quick, times, 4.5, 0.65) + driven(
            {1.5: 0, kick - 0.12: 8, kick: 2, landed: 6, 2.8: 0}, times) + 3.0 * ring,
        "roll": sprung(-6.0 * hook + 5.0 * away - 3.0 * jabs, times, 5.0, 0.6),
        "yaw": sprung(18.0 * cross - 18.0 * jabs - 28.0 * hook + 12.0 * thrown, times, 7.0, 0.58)
            + sprung(22.0 * last_right - 24.0 * last_left, times, 7.0, 0.58),
        "neck_yaw": 30.0 - sprung(38.0 * cross - 24.0 * jabs - 50.0 * hook, times, 6.5, 0.7) + driven(
            {1.5: 0, kick: -46, landed: -56, 2.9: -58}, times) + sprung(36.0 * last_left - 30.0 * last_right,
                                                                        times, 6.5, 0.7),
        "neck_pitch": -8.0 + sprung(12.0 * away, times, 4.5, 0.7) + driven({1.5: 0, kick: 14, 2.3: 0}, times),
    }  # fmt: skip
    return choreography(times, random, pelvis, trunk, {"L": left, "R": right}, _feet(times, random, cross),
                        {"R": _kicking(times)})  # fmt: skip


def _punch(times: Array, at: float) -> Array:
    """A punch: out in a sixth of a second, back in a fifth."""
    return burst(times, at - 0.17, at, at + 0.22)


def _feet(times: Array, random: np.random.Generator, cross: Array) -> dict[str, tuple[Array, Array]]:
    """The front foot steps with the first jab; the rear one kicks and lands before it."""
    off, landed = KICK_S - 0.42, LANDED_S
    steps = {
        "L": [(0.18, 0.34, (0.14, -0.30)), (landed + 0.10, landed + 0.26, (0.15, -0.22))],
        "R": [(0.36, 0.50, (-0.13, 0.14)), (off + 0.1, landed, (-0.10, -0.62))],
    }
    yaws = {
        "L": driven({0.0: -8, KICK_S - 0.35: -8, KICK_S: 26, landed + 0.1: 24, landed + 0.3: 50}, times),
        "R": driven({0.0: -54, KICK_S - 0.4: -50, KICK_S: -10, landed: 4}, times),
    }
    feet = {}
    for side, start, heel in (("L", (0.13, -0.12), 4.0), ("R", (-0.13, 0.28), 17.0)):
        places, lifted = stepped(times, start, steps[side])
        slide = 0.005 * np.stack([sway(FPS * times, random, (10.0, 24.0)) for _ in "xy"], axis=-1)
        turn = sprung(34.0 * cross * (side == "R"), times, 6.5, 0.7)
        pitch = (
            heel * (1.0 if side == "L" else 1.0 - 0.75 * (times > landed))
            + 0.4 * np.abs(turn)
            + 13.0 * lifted
        )
        feet[side] = foot(places + slide, yaws[side] + turn, sprung(pitch, times, 6.0, 0.9), 0.035 * lifted)
    return feet


def _kicking(times: Array) -> FreeLeg:
    """The right leg in the air: chamber, snap, recoil."""
    at = KICK_S
    share = driven({at - 0.40: 0, at - 0.27: 1, at + 0.24: 1, at + 0.38: 0}, times, 8.0, 1.0)
    leg = free(times, share, {"outward": 5.0, "twist": 4.0})
    leg.flexion[:] = driven(
        {at - 0.4: 14, at - 0.13: 92, at: 101, at + 0.16: 86, at + 0.45: 40}, times, 6.5, 0.6
    )
    leg.knee[:] = driven(
        {at - 0.4: 62, at - 0.17: 124, at - 0.12: 118, at + 0.01: 11, at + 0.05: 11, at + 0.16: 104,
         at + 0.45: 56}, times, 8.5, 0.55)  # fmt: skip
    leg.ankle[:] = driven({at - 0.4: 12, at - 0.1: -4, at: 16, at + 0.3: 5}, times)
    return leg
