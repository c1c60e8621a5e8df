"""A fast sidearm throw with the left arm: a stride, then hips, trunk and arm, each faster than the last."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, shock
from ..performance import Choreography
from ..standing import arm, choreography, foot, stepped, tall_m

PLANT_S, RELEASE_S = 0.74, 0.90
READY = {"elevation": 26, "forward": 62, "rotation": 30, "flexion": 98, "pronation": 20, "girdle": 2}
COCKED = {"elevation": 88, "forward": -22, "rotation": -50, "flexion": 84, "pronation": 25, "girdle": 9}
RELEASED = {"elevation": 86, "forward": 44, "rotation": 6, "flexion": 16, "pronation": 50, "girdle": 10}
THROUGH = {"elevation": 56, "forward": 108, "rotation": 48, "flexion": 50, "pronation": 70, "girdle": 3}
AIMING = {"elevation": 82, "forward": 40, "rotation": 20, "flexion": 22, "pronation": 20, "girdle": 8}
TUCKED = {"elevation": 30, "forward": 16, "rotation": 18, "flexion": 106, "girdle": 0}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    plant, release = PLANT_S, RELEASE_S
    ring = shock(times, [plant], 6.0, 0.08)
    pelvis = {
        "x": driven({0.0: 0.0, 0.4: 0.03, plant: 0.0, 1.2: -0.04, 1.6: -0.03}, times, 3.0),
        "y": driven({0.0: 0.16, 0.36: 0.22, 0.56: 0.12, plant: -0.08, release: -0.18, 1.2: -0.30, 1.6: -0.28},
                    times, 4.0, 0.8),
        "z": tall_m(body) - 0.01 * ring - driven(
            {0.0: 0.05, 0.34: 0.08, 0.56: 0.12, plant: 0.16, release + 0.06: 0.11, 1.3: 0.12, 1.7: 0.07},
            times, 5.0, 0.7),
        "yaw": driven({0.0: 42, 0.32: 66, 0.54: 66, 0.64: 46, 0.76: 8, 0.88: -16, 1.2: -38,
                       1.7: -30},
                      times, 6.0, 0.65),
        "pitch": driven({0.0: 4, 0.5: 2, plant: 0, release + 0.05: 15, 1.2: 24, 1.7: 10}, times),
        "roll": driven({0.3: 0, 0.66: -6, release: 5, 1.3: 2, 1.6: 0}, times),
    }  # fmt: skip
    trunk = {
        "pitch": driven({0.0: 6, 0.5: 2, plant: 0, release: 12, 1.16: 28, 1.7: 10}, times,
                        5.5, 0.6) + 2.0 * ring,
        "roll": driven({0.4: 0, 0.7: 6, release: -4, 1.2: -12, 1.6: -2}, times),
        "yaw": driven({0.0: 6, 0.5: 20, plant: 30, 0.84: 12, release + 0.06: -20, 1.16: -34, 1.6: -14},
                      times, 5.5, 0.65),
        "neck_yaw": driven({0.0: -40, 0.5: -66, plant: -60, release: 12, 1.2: 36, 1.6: 22}, times, 5.0, 0.8),
        "neck_pitch": driven({0.5: 0, release: -10, 1.2: -26, 1.7: -10}, times),
    }  # fmt: skip
    cocked = driven({0.14: 0, 0.5: 0.9, plant: 1, 0.82: 0.9, release: 0}, times, 8.0, 0.75)
    released = driven({0.80: 0, release + 0.01: 1, 0.97: 0.8, 1.12: 0}, times, 9.0, 0.75)
    through = driven({release + 0.02: 0, 1.13: 1, 1.30: 0.9, 1.66: 0.15}, times, 6.0, 0.65)
    aiming = driven({0.16: 0, 0.54: 1, plant: 0.9, 0.86: 0}, times)
    tucked = burst(times, 0.72, 0.94, 1.5)
    arms = {
        "L": arm(times, READY, (cocked, COCKED), (released, RELEASED), (through, THROUGH)),
        "R": arm(times, READY, (aiming, AIMING), (tucked, TUCKED)),
    }
    return choreography(times, random, pelvis, trunk, arms, _feet(times))


def _feet(times: Array) -> dict[str, tuple[Array, Array]]:
    """The right foot strides; the left one is dragged after the throw."""
    steps = {"R": [(0.34, PLANT_S, (-0.15, -0.42))], "L": [(RELEASE_S + 0.02, 1.30, (0.16, -0.40))]}
    yaws = {"R": {0.3: 20, 0.6: 26, PLANT_S: 6}, "L": {0.4: 78, 0.76: 72, 0.96: 20, 1.3: -12}}
    drag = 44.0 * burst(times, PLANT_S - 0.10, RELEASE_S + 0.04, 1.24)
    feet = {}
    for side, start in (("R", (-0.12, 0.04)), ("L", (0.14, 0.30))):
        places, lifted = stepped(times, start, steps[side])
        strike = -12.0 * burst(times, PLANT_S - 0.12, PLANT_S - 0.02, PLANT_S + 0.06) * (side == "R")
        pitch = strike + 18.0 * lifted + drag * (side == "L")
        feet[side] = foot(places, driven(yaws[side], times, 6.0, 0.8), pitch, 0.06 * lifted)
    return feet
