"""Walking in, turning to whoever looks, waving, and showing the way in with the other arm."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, keyed, shock, sprung, uneven_phases
from ..performance import Choreography
from ..standing import HANGING, arm, choreography, foot, stepped, tall_m

LANDINGS_S = (0.48, 0.98, 1.42, 3.02)
STRIDE_S = 1.0
SWINGING = {"elevation": 4, "forward": 84, "rotation": 10, "flexion": 24, "pronation": 15, "girdle": 2}
WAVING = {"elevation": 82, "forward": 34, "rotation": -38, "flexion": 88, "pronation": 10, "girdle": 10}
INVITING = {"elevation": 76, "forward": 14, "rotation": -4, "flexion": 34, "pronation": -50, "girdle": 8}
AT_CHEST = {"elevation": 30, "forward": 62, "rotation": 52, "flexion": 88, "pronation": 10, "girdle": 2}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion, from +Y and -X toward the origin, then facing -Y."""
    walking = keyed({0.9: 1, 1.5: 0}, times)
    turn = 2.0 * np.pi * times / STRIDE_S
    ring = shock(times, list(LANDINGS_S), 6.0, 0.08)
    wave = driven({1.0: 0, 1.42: 1, 2.46: 1, 2.86: 0}, times, 3.6, 0.66)
    invite = driven({2.5: 0, 2.96: 1, 3.6: 1, 4.2: 0.1}, times, 3.4, 0.68)
    chest = driven({2.6: 0, 3.1: 1, 3.7: 1, 4.2: 0.2}, times, 3.2, 0.8)
    shake = sprung(np.sin(2.0 * np.pi * uneven_phases(times, 0.36, 0.08, random)), times, 6.0, 0.6)
    pelvis = {
        "x": driven({0.0: -0.84, 0.45: -0.50, 0.9: -0.12, 1.4: 0.06, 2.6: 0.05, 3.0: 0.10, 3.6: 0.13,
                     4.2: 0.08}, times, 3.4, 0.95),
        "y": driven({0.0: 0.47, 0.45: 0.22, 0.9: 0.0, 1.4: -0.07, 2.6: -0.07, 3.0: -0.01, 4.2: 0.0},
                    times, 3.4, 0.95),
        "z": tall_m(body) - 0.030 - 0.018 * walking * np.cos(2.0 * turn - 0.5) - 0.004 * ring,
        "yaw": driven({0.0: 56, 0.7: 50, 1.3: 4, 2.5: -4, 3.0: 20, 3.7: 24, 4.3: 12}, times, 3.2, 0.8)
        + 6.0 * walking * np.cos(turn + 0.2),
        "pitch": 4.0 + 2.0 * walking + 5.0 * burst(times, 1.6, 2.0, 2.5),
        "roll": 4.0 * walking * np.sin(turn + 0.4) + driven({1.4: 0, 1.9: -3, 2.7: 0, 3.2: 4}, times),
    }  # fmt: skip
    trunk = {
        "pitch": 2.0 - ring + driven({1.5: 0, 1.9: 7, 2.5: 2, 3.1: 9, 3.9: 1}, times, 3.6, 0.7),
        "roll": -4.0 * walking * np.sin(turn + 0.4)
        + driven({1.0: 0, 1.5: 6, 2.5: 6, 3.0: -7, 4.1: 0}, times),
        "yaw": -11.0 * walking * np.cos(turn + 0.2)
        + driven({0.8: 0, 1.4: 8, 2.5: 6, 3.0: 18, 3.7: 16, 4.3: 2}, times, 3.8, 0.7),
        "neck_yaw": driven({0.2: 0, 0.7: -34, 1.4: -6, 2.5: 2, 2.9: 26, 3.4: 22, 3.9: -24}, times, 3.6, 0.75),
        "neck_pitch": driven({1.4: 0, 1.8: 9, 2.2: -5, 2.7: 0, 3.2: 6, 4.0: 0}, times, 4.0, 0.6),
        "neck_roll": driven({1.2: 0, 1.7: -8, 2.5: -5, 3.2: 6, 4.2: 0}, times),
    }  # fmt: skip
    swings = {"L": np.cos(turn), "R": -np.cos(turn)}
    gestures = {"L": ((invite, INVITING),), "R": ((wave, WAVING), (chest, AT_CHEST))}
    arms = {}
    for side, gesture in gestures.items():
        swing = sprung(walking * swings[side], times, 4.0, 0.7)
        hanging = (1.0 - walking) * (1.0 - sum(amount for amount, _ in gesture))
        arms[side] = arm(
            times, SWINGING, (swing, {"elevation": 30, "flexion": 42}), (hanging, HANGING), *gesture
        )
    arms["R"]["flexion"] = arms["R"]["flexion"] + 26.0 * wave * shake
    arms["R"]["twist"] = arms["R"]["twist"] + 30.0 * wave * shake
    return choreography(times, random, pelvis, trunk, arms, _feet(times))


def _feet(times: Array) -> dict[str, tuple[Array, Array]]:
    """Three steps in, the last beside the other foot, and later one aside to make room."""
    steps = {
        "L": [(0.06, LANDINGS_S[0], (-0.26, 0.16)), (1.06, LANDINGS_S[2], (0.17, -0.07))],
        "R": [(0.56, LANDINGS_S[1], (-0.07, -0.12)), (2.66, LANDINGS_S[3], (-0.12, 0.09))],
    }
    yaws = {"L": {0.06: 58, 0.48: 50, 1.06: 46, 1.42: 14}, "R": {0.56: 48, 0.98: 4, 2.66: 2, 3.02: -8}}
    feet = {}
    for side, start in (("L", (-0.99, 0.65)), ("R", (-0.73, 0.27))):
        places, lifted = stepped(times, start, steps[side])
        push = sum(burst(times, lifts - 0.2, lifts + 0.04, lifts + 0.24) for lifts, _, _ in steps[side])
        toes = 26.0 * push - 12.0 * sum(
            burst(times, lands - 0.16, lands - 0.02, lands + 0.1) for _, lands, _ in steps[side]
        )
        feet[side] = foot(places, driven(yaws[side], times, 6.0, 0.9), toes, 0.05 * lifted)
    return feet
