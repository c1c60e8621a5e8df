"""Two countermovement jumps: arms back and up, flight, uneven landing; the second turns and tucks."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, flight, keyed, shock
from ..performance import Choreography
from ..standing import arm, choreography, foot, tall_m

FIRST_S, SECOND_S = (0.86, 1.37), (2.05, 2.60)
"""Takeoff and landing."""
TURN_DEG = 52.0
ON_TOES_M = 0.082
LOW = {"elevation": 16, "forward": 74, "rotation": 10, "flexion": 22, "pronation": 15, "girdle": 0}
BACK = {"elevation": -44, "flexion": 14}
UP = {"elevation": 158, "flexion": 12, "girdle": 24, "rotation": 20}
WIDE = {"elevation": 78, "forward": 22, "flexion": 38, "rotation": 24, "girdle": 10}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    (off, on), (off_again, on_again) = FIRST_S, SECOND_S
    height = flight(times, off, on) + flight(times, off_again, on_again)
    drop = keyed(
        {-0.1: 0.01, 0.18: 0.02, 0.50: 0.30, 0.60: 0.33, 0.76: 0.13, off: -ON_TOES_M, on: -ON_TOES_M + 0.01,
         on + 0.08: 0.10, on + 0.17: 0.20, 1.72: 0.18, 1.84: 0.31, off_again: -ON_TOES_M,
         on_again: -ON_TOES_M + 0.04, on_again + 0.08: 0.18, on_again + 0.19: 0.36, on_again + 0.45: 0.10,
         on_again + 0.65: 0.05}, times)  # fmt: skip
    ring = shock(times, [on, on + 0.03, on_again])
    bend = driven({0.15: 0, 0.52: 1, 0.84: -0.12, 1.2: 0.1, on + 0.2: 0.62, 1.84: 1, off_again: -0.15,
                   2.3: 0.45, on_again + 0.2: 1.15, on_again + 0.6: 0.15}, times, 5.0, 0.7)  # fmt: skip
    turn = driven({1.5: 0, 1.86: -16, off_again: 4, on_again: TURN_DEG, 3.0: TURN_DEG - 6}, times, 5.0, 0.75)
    pelvis = {
        "x": driven({0.5: 0.01, on + 0.1: 0.05, 1.8: 0.03, on_again + 0.1: -0.07, 3.0: -0.05}, times, 3.0),
        "y": 0.03
        + driven(
            {0.1: 0.0, 0.55: 0.07, off: -0.03, on + 0.15: 0.0, 1.84: 0.06, on_again + 0.2: 0.05, 2.95: -0.02},
            times,
            3.5,
        ),
        "z": tall_m(body) + height - drop,
        "yaw": turn,
        "pitch": 26.0 * bend + 2.0 * ring,
        "roll": 3.0 * burst(times, on, on + 0.06, on + 0.3)
        - 5.0 * burst(times, on_again, on_again + 0.08, 3.0),
    }
    trunk = {
        "pitch": 22.0 * bend - 3.0 * ring,
        "roll": -4.0 * ring,
        "yaw": driven(
            {1.6: 0, 1.88: -18, off_again + 0.1: 26, on_again: 8, on_again + 0.2: -10, 3.0: 0}, times
        ),
        "neck_pitch": -24.0 * bend - 4.0 * burst(times, off, 1.1, on) + 6.0 * ring,
        "neck_yaw": driven({1.6: 0, 1.8: 22, off_again + 0.15: 16, on_again: -10, 3.0: -14}, times),
    }
    arms = {}
    for side, late in (("L", 0.0), ("R", 0.025)):
        back = driven(
            {0.12: 0, 0.40 + late: 1, 0.48 + late: 1, 0.76: 0, 1.5: 0, 1.72 + late: 0.8, 1.96: 0},
            times,
            4.0,
            0.7,
        )
        up = driven({0.56: 0, 0.94 + late: 1, 1.08: 0.9, on: 0.35, on + 0.2: 0.05, 1.80: 0,
                     2.12 + late: 0.8, 2.36: 0.4, on_again + 0.15: 0.1}, times, 4.0, 0.65)  # fmt: skip
        wide = burst(times, on - 0.1, on + 0.08 + late, on + 0.4) + burst(
            times, 2.3, on_again + 0.05, 3.0 + late
        )
        arms[side] = arm(times, LOW, (back, BACK), (up, UP), (wide * (1.0 if side == "L" else 0.8), WIDE))
    return choreography(times, random, pelvis, trunk, arms, _feet(times, height))


def _feet(times: Array, height: Array) -> dict[str, tuple[Array, Array]]:
    (off, on), (off_again, on_again) = FIRST_S, SECOND_S
    feet = {}
    for side, out, late in (("L", 1.0, 0.0), ("R", -1.0, 0.03)):
        toes = keyed({0.55: 0, 0.7: 8, off: 52, on - 0.12: 44, on + late: 24, on + late + 0.07: 0, 1.9: 0,
                      off_again: 50, 2.35: 30, on_again - late: 26,
                      on_again + 0.07 - late: 0}, times)  # fmt: skip
        tuck = 0.03 * burst(times, off, 1.15, on + late) + 0.24 * burst(
            times, off_again + 0.02, 2.34, on_again - late
        )
        flown = height * np.where(times < 1.7, 1.0, 0.98) + tuck
        wide = keyed({off: 0.12, on: 0.155, 1.7: 0.155, off_again: 0.15, on_again: 0.21}, times)
        ahead = keyed({off: 0.0, on: -0.02 * out, off_again: -0.02 * out, on_again: 0.05 * out}, times)
        eased = keyed({off_again: 0.0, on_again: 1.0}, times) * np.radians(TURN_DEG)
        place = np.stack([out * wide * np.cos(eased) - ahead, out * wide * np.sin(eased) + ahead], axis=-1)
        yaw = out * 10.0 + np.degrees(eased)
        feet[side] = foot(place, yaw, toes, flown)
    return feet
