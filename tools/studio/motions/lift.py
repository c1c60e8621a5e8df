"""Bending down for a box, heaving it up, turning with it, putting it high on a shelf, and letting go."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, shock
from ..performance import Choreography
from ..standing import HANGING, arm, choreography, foot, stepped, tall_m

GRASP_S, UP_S, PUT_S = 1.02, 1.62, 2.62
DOWN = {"elevation": 62, "forward": 84, "rotation": 26, "flexion": 22, "pronation": -10, "girdle": -2}
HELD = {"elevation": 22, "forward": 66, "rotation": 14, "flexion": 84, "pronation": -30, "girdle": 2}
PUSHED = {"elevation": 108, "forward": 86, "rotation": 18, "flexion": 28, "pronation": 0, "girdle": 12}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    stoop = driven({0.25: 0, 0.62: 0.62, 0.92: 1.0, GRASP_S + 0.1: 1.0, 1.28: 0.62, UP_S: 0.05, 1.8: -0.04,
                    2.3: 0.08,
                    PUT_S: -0.02, 3.7: 0.02}, times, 3.6, 0.7)  # fmt: skip
    squat = driven({0.3: 0.05, 0.66: 0.6, 0.95: 1.0, GRASP_S + 0.06: 1.02, 1.2: 0.62, 1.5: 0.14,
                    UP_S: 0.10, 1.95: 0.2,
                    PUT_S - 0.2: 0.28, PUT_S: 0.02, 3.1: 0.1}, times, 3.8, 0.7)  # fmt: skip
    turn = driven({1.6: 0, 1.86: -20, 2.2: -58, 2.4: -70, 3.05: -68, 3.3: -46, 3.7: -34}, times, 3.5, 0.75)
    jerk = burst(times, GRASP_S + 0.04, GRASP_S + 0.16, GRASP_S + 0.4)
    ring = shock(times, [0.32, 2.14, 2.4], 6.0, 0.08)
    down = driven({0.45: 0, 0.86: 1, GRASP_S + 0.12: 1, 1.5: 0}, times, 4.0, 0.7)
    held = driven({GRASP_S + 0.1: 0, 1.5: 1, PUT_S - 0.34: 1, PUT_S - 0.06: 0}, times, 4.0, 0.65)
    pushed = driven({PUT_S - 0.36: 0, PUT_S: 1, PUT_S + 0.2: 1, PUT_S + 0.46: 0.0}, times, 4.5, 0.6)
    pelvis = {
        "x": driven({0.0: 0.02, 1.7: 0.0, 2.2: -0.12, 2.5: -0.20, 3.2: -0.14, 3.7: -0.08}, times, 3.0),
        "y": driven(
            {0.0: 0.26, 0.3: 0.10, 0.6: 0.14, 0.95: 0.20, 1.3: 0.10, UP_S: 0.0, 2.2: -0.02, 3.7: 0.0},
            times,
            3.2,
        ),
        "z": tall_m(body) - 0.02 - 0.30 * squat - 0.006 * ring - 0.02 * jerk,
        "yaw": turn,
        "pitch": 4.0 + 38.0 * stoop + 3.0 * jerk,
        "roll": driven({1.7: 0, 1.95: 6, 2.2: -5, 2.5: 0, 3.2: 4, 3.5: 0}, times) + 3.0 * jerk,
    }
    trunk = {
        "pitch": 3.0 + 44.0 * stoop + 8.0 * jerk - 9.0 * held - 7.0 * pushed + 2.0 * ring,
        "roll": -6.0 * jerk + driven({1.8: 0, 2.1: -8, 2.4: 3, 3.0: 6, 3.4: 0}, times),
        "yaw": 9.0 * jerk + driven({1.5: 0, 1.72: -16, 2.1: -10, PUT_S: -22, 3.2: 14, 3.6: 4}, times),
        "neck_pitch": 6.0 - 30.0 * stoop + 8.0 * held - 16.0 * pushed,
        "neck_yaw": driven({1.2: 0, 1.55: -38, 2.2: -12, 2.9: 10, 3.15: 46, 3.6: 30}, times, 4.0, 0.8),
    }
    arms = {}
    for side, uneven in (("L", 1.0), ("R", 0.93)):
        away = burst(times, PUT_S + 0.2, PUT_S + 0.45, PUT_S + 0.9)
        arms[side] = arm(
            times, HANGING, (uneven * down, DOWN), (held, HELD), (pushed * uneven, PUSHED),
            (away, {"elevation": 42, "forward": 40 if side == "L" else 10, "flexion": 62}),
        )  # fmt: skip
    return choreography(times, random, pelvis, trunk, arms, _feet(times, squat))


def _feet(times: Array, squat: Array) -> dict[str, tuple[Array, Array]]:
    steps = {
        "L": [(-0.05, 0.30, (0.19, -0.06)), (2.0, 2.38, (0.02, -0.24)), (3.1, 3.4, (0.06, -0.12))],
        "R": [(1.78, 2.12, (-0.26, 0.10)), (3.36, 3.62, (-0.20, 0.08))],
    }
    yaws = {"L": {1.95: 16, 2.38: -42, 3.1: -42, 3.4: -18}, "R": {1.78: -20, 2.12: -92, 3.36: -92, 3.62: -60}}
    feet = {}
    for side, start in (("L", (0.14, 0.30)), ("R", (-0.17, 0.05))):
        places, lifted = stepped(times, start, steps[side])
        heel = 16.0 * np.clip(squat - 0.5, 0.0, None) * (2.0 if side == "R" else 0.6)
        reaching = 20.0 * burst(times, PUT_S - 0.2, PUT_S + 0.05, PUT_S + 0.4) * (side == "R")
        feet[side] = foot(
            places, driven(yaws[side], times, 6.0, 0.9), heel + reaching + 16.0 * lifted, 0.06 * lifted
        )
    return feet
