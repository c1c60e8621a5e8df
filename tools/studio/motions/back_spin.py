"""Seen from behind: a step, a turn to the front in three steps, a sway, and a turn on to the back."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, shock, sway
from ..performance import FPS, Choreography
from ..standing import arm, choreography, foot, stepped, tall_m

STEPS_S = (0.34, 0.74, 1.02, 1.28, 1.98, 2.26, 2.54)
"""When feet land."""
EASY = {"elevation": 26, "forward": 34, "rotation": 18, "flexion": 52, "pronation": 20, "girdle": 2}
OUT = {"elevation": 80, "forward": 14, "rotation": 6, "flexion": 26, "pronation": -20, "girdle": 9}
HUG = {"elevation": 58, "forward": 94, "rotation": 54, "flexion": 82, "pronation": 25, "girdle": 5}
RAISED = {"elevation": 140, "forward": 34, "rotation": 2, "flexion": 42, "pronation": 0, "girdle": 21}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion; it starts with the back to -Y and turns to the left."""
    yaw = driven(
        {0.0: 176, 0.30: 172, 0.56: 164, 0.74: 206, 1.02: 306, 1.28: 366, 1.46: 376, 1.74: 358, 1.98: 406,
         2.26: 498, 2.54: 544, 2.9: 538}, times, 5.0, 0.75)  # fmt: skip
    lead = driven(
        {0.0: 0, 0.36: -10, 0.56: -24, 0.78: 16, 1.08: 14, 1.34: -16, 1.7: -18, 1.96: 16, 2.3: 12, 2.6: -12,
         2.95: 0}, times, 4.5, 0.62)  # fmt: skip
    neck = driven(
        {0.0: 14, 0.4: 8, 0.62: 46, 0.86: 58, 1.1: 30, 1.34: -6, 1.6: 8, 1.8: -22, 2.0: -44, 2.14: 20,
         2.3: 48, 2.6: 6}, times, 5.5, 0.8)  # fmt: skip
    ring = shock(times, list(STEPS_S), 6.0, 0.08)
    sink = sum(burst(times, at - 0.12, at + 0.06, at + 0.26) for at in STEPS_S)
    spun = burst(times, 0.60, 0.94, 1.36) + 0.8 * burst(times, 1.84, 2.14, 2.56)
    pelvis = {
        "x": driven({0.0: 0.0, 0.34: 0.04, 0.74: 0.03, 1.02: -0.10, 1.28: -0.09, 1.7: -0.06, 2.0: 0.03,
                     2.3: 0.0, 2.6: 0.05}, times, 3.0, 0.8),
        "y": driven({0.0: -0.10, 0.34: -0.05, 0.74: -0.06, 1.02: -0.03, 1.28: 0.0, 1.6: -0.01, 2.0: -0.11,
                     2.3: -0.03, 2.6: 0.09}, times, 3.0, 0.8),
        "z": tall_m(body) - 0.055 - 0.050 * sink + 0.015 * spun - 0.006 * ring,
        "yaw": yaw,
        "pitch": 3.0 + 4.0 * sink + 1.5 * ring,
        "roll": driven({0.0: 2, 0.34: -5, 0.8: 5, 1.1: -4, 1.5: 6, 1.75: -5, 2.1: 4, 2.5: -4, 2.9: 0}, times),
    }  # fmt: skip
    trunk = {
        "pitch": 4.0 + 6.0 * sink - 7.0 * spun + 2.0 * ring,
        "roll": driven({0.0: -2, 0.34: 7, 0.8: -9, 1.2: 6, 1.5: -10, 1.75: 9, 2.1: -7, 2.5: 5}, times),
        "yaw": lead,
        "neck_yaw": neck,
        "neck_pitch": -3.0 + 3.0 * sway(FPS * times, random, (30.0, 60.0)),
    }
    wound = burst(times, 0.30, 0.56, 0.80) + 0.7 * burst(times, 1.56, 1.76, 1.96)
    thrown = driven(
        {0.60: 0, 0.80: 1, 0.98: 0.4, 1.2: 0.2, 1.36: 0.8, 1.5: 0.2, 1.84: 0, 2.04: 1, 2.3: 0.3, 2.6: 0.5,
         2.95: 0.1}, times, 4.5, 0.6)  # fmt: skip
    close = driven({0.84: 0, 1.0: 0.8, 1.14: 0.7, 1.32: 0, 2.06: 0, 2.24: 0.7, 2.4: 0}, times, 4.5, 0.65)
    swayed = burst(times, 1.38, 1.62, 1.88)
    arms = {
        "L": arm(times, EASY, (0.9 * thrown, OUT), (close, HUG), (0.9 * swayed, RAISED), (0.3 * wound, OUT)),
        "R": arm(times, EASY, (thrown, OUT), (0.8 * close, HUG), (0.9 * wound, HUG), (0.4 * swayed, OUT)),
    }
    return choreography(times, random, pelvis, trunk, arms, _feet(times))


def _feet(times: Array) -> dict[str, tuple[Array, Array]]:
    """Three steps a turn; the foot that stays turns on its ball after the hips."""
    first, second, third, fourth, fifth, sixth, seventh = STEPS_S
    steps = {
        "L": [(second - 0.20, second, (-0.05, -0.13)), (fourth - 0.19, fourth, (0.06, -0.05)),
              (sixth - 0.20, sixth, (-0.06, 0.13))],
        "R": [(0.14, first, (0.18, 0.03)), (third - 0.21, third, (-0.23, 0.08)),
              (fifth - 0.19, fifth, (0.02, -0.21)), (seventh - 0.20, seventh, (0.17, 0.08))],
    }  # fmt: skip
    yaws = {
        "L": driven({0.0: 188, second - 0.2: 186, second: 250, third: 284, fourth - 0.18: 330, fourth: 384,
                     fifth: 406, sixth - 0.2: 430, sixth: 516, seventh: 552}, times, 7.0, 0.9),
        "R": driven({0.0: 166, second: 176, third - 0.2: 206, third: 318, fourth: 346, fifth - 0.18: 356,
                     fifth: 424, sixth: 462, seventh - 0.2: 482, seventh: 530}, times, 7.0, 0.9),
    }  # fmt: skip
    feet = {}
    for side, start in (("L", (-0.11, -0.10)), ("R", (0.11, -0.12))):
        places, lifted = stepped(times, start, steps[side])
        rate = np.abs(np.gradient(yaws[side], times))
        pivot = 9.0 * np.clip(rate / 250.0, 0.0, 1.0)
        feet[side] = foot(places, yaws[side], 3.0 + pivot + 14.0 * lifted, 0.035 * lifted)
    return feet
