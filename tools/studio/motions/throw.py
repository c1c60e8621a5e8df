"""A throw over the shoulder with a run-up of two steps: hips lead, the trunk follows, the arm whips last."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, shock
from ..performance import Choreography
from ..standing import arm, choreography, foot, stepped, tall_m

PLANT_S, RELEASE_S = 0.96, 1.12
READY = {"elevation": 28, "forward": 50, "rotation": 20, "flexion": 84, "pronation": 20, "girdle": 2}
COCKED = {"elevation": 94, "forward": -18, "rotation": -62, "flexion": 92, "pronation": 30, "girdle": 12}
RELEASED = {"elevation": 112, "forward": 42, "rotation": -6, "flexion": 24, "pronation": 55, "girdle": 18}
THROUGH = {"elevation": 48, "forward": 106, "rotation": 44, "flexion": 36, "pronation": 70, "girdle": 2}
AIMING = {"elevation": 84, "forward": 62, "rotation": 30, "flexion": 28, "pronation": 30, "girdle": 9}
TUCKED = {"elevation": 30, "forward": 10, "rotation": 16, "flexion": 104, "girdle": 0}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    plant, release = PLANT_S, RELEASE_S
    ring = shock(times, [0.34, 0.66, plant], 6.0, 0.08)
    pelvis = {
        "x": driven({0.0: 0.02, 0.7: -0.04, plant: 0.0, 1.4: 0.06, 1.9: 0.05}, times, 3.0),
        "y": driven({0.0: 0.62, 0.34: 0.42, 0.66: 0.20, plant: -0.06, release: -0.20, 1.4: -0.40,
                     1.6: -0.46, 1.9: -0.42}, times, 4.0, 0.8),
        "z": tall_m(body) - driven({0.0: 0.05, 0.3: 0.09, 0.5: 0.05, 0.72: 0.10, plant: 0.13,
                                    release + 0.05: 0.06,
                                    1.4: 0.10, 1.6: 0.14, 2.0: 0.07}, times, 5.0, 0.7) - 0.01 * ring,
        "yaw": driven({0.0: -14, 0.4: -42, 0.72: -68, 0.90: -52, 1.04: 4, release + 0.03: 26, 1.4: 40,
                       2.0: 24}, times, 6.0, 0.65),
        "pitch": driven({0.0: 4, 0.75: -6, plant: -7, release + 0.05: 14, 1.4: 28, 1.7: 20, 2.0: 8}, times),
        "roll": driven({0.5: 0, 0.85: 7, release: -6, 1.5: -3, 1.9: 0}, times),
    }  # fmt: skip
    trunk = {
        "pitch": driven({0.0: 5, 0.8: -10, plant: -12, release: 12, 1.36: 34, 1.7: 22, 2.0: 8}, times, 5.5,
                        0.6) + 2 * ring,
        "roll": driven({0.6: 0, 0.9: -6, release: 16, 1.3: 12, 1.7: 0}, times),
        "yaw": driven({0.2: 0, 0.7: -26, plant: -36, 1.06: -10, release + 0.04: 28, 1.36: 40, 1.8: 14},
                      times, 6.5, 0.6),
        "neck_yaw": driven({0.1: 12, 0.7: 66, plant: 60, release: -10, 1.4: -34, 1.9: -16}, times, 5.0, 0.8),
        "neck_pitch": driven({0.6: 0, release: -10, 1.4: -30, 1.9: -10}, times),
    }  # fmt: skip
    cocked = driven({0.25: 0, 0.66: 0.9, plant: 1, 1.04: 0.9, release: 0}, times, 8.0, 0.75)
    released = driven({1.03: 0, release: 1, 1.18: 0.8, 1.3: 0}, times, 9.0, 0.75)
    through = driven({release: 0, 1.3: 1, 1.5: 0.9, 1.9: 0.1}, times, 6.0, 0.65)
    aiming = driven({0.3: 0, 0.72: 1, plant: 0.9, 1.1: 0}, times)
    tucked = burst(times, 0.94, 1.16, 1.7)
    arms = {
        "R": arm(times, READY, (cocked, COCKED), (released, RELEASED), (through, THROUGH)),
        "L": arm(times, READY, (aiming, AIMING), (tucked, TUCKED)),
    }
    return choreography(times, random, pelvis, trunk, arms, _feet(times))


def _feet(times: Array) -> dict[str, tuple[Array, Array]]:
    steps = {
        "L": [(0.06, 0.34, (0.13, 0.24)), (0.68, PLANT_S, (0.15, -0.36))],
        "R": [(0.36, 0.66, (-0.08, 0.16)), (1.16, 1.48, (-0.14, -0.58))],
    }
    yaws = {"L": {0.3: -14, 0.7: -30, PLANT_S: -8}, "R": {0.36: -30, 0.66: -84, 1.0: -74, 1.2: -20, 1.5: 12}}
    drag = 46.0 * burst(times, PLANT_S - 0.08, 1.16, 1.44)
    feet = {}
    for side, start in (("L", (0.12, 0.56)), ("R", (-0.12, 0.72))):
        places, lifted = stepped(times, start, steps[side])
        strike = -14.0 * burst(times, PLANT_S - 0.12, PLANT_S - 0.02, PLANT_S + 0.06) * (side == "L")
        pitch = strike + 20.0 * lifted + drag * (side == "R")
        feet[side] = foot(places, driven(yaws[side], times, 6.0, 0.8), pitch, 0.07 * lifted)
    return feet
