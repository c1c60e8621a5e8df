"""Walking past briskly while waving, with heel strike, push-off, and an arm that swings.

The curves of the feet are drawn after those of normal walking in Winter (2009), *Biomechanics and Motor
Control of Human Movement*.
"""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import cyclic, driven, shock, sprung, sway, uneven_phases
from ..performance import FPS, Choreography
from ..standing import arm, choreography, foot, tall_m

STRIDE_S, STRIDE_M, UNEVENNESS = 1.0, 1.08, 0.03
SWING = 0.62
"""Share of the stride after which a foot swings."""
ASIDE_M = 0.065
TURNED_DEG = -90.0
START_M = 1.62
PITCH = {0.0: -19, 0.06: -6, 0.12: 0, 0.34: 0, 0.46: 14, 0.58: 42, 0.64: 56, 0.76: 26, 0.88: -10, 0.95: -19}
LIFT_M = {0.0: 0.0, 0.62: 0.0, 0.70: 0.025, 0.80: 0.03, 0.92: 0.02}
WAVING = {"elevation": 136, "forward": 22, "rotation": -8, "flexion": 62, "pronation": 20, "girdle": 20}
SWINGING = {"elevation": 3, "forward": 80, "rotation": 12, "flexion": 22, "pronation": 15, "girdle": 2}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion, along -X."""
    phases = uneven_phases(times, STRIDE_S, UNEVENNESS, random)
    turn = 2.0 * np.pi * phases
    walked = STRIDE_M * phases - START_M
    strikes = [float(np.interp(half / 2.0, phases, times)) for half in range(1, int(2 * phases[-1]))]
    ring = shock(times, strikes, 6.0, 0.08)
    pelvis = {
        "x": -(walked + 0.10 + 0.018 * np.sin(2.0 * turn + 0.6)),
        "y": 0.022 * np.sin(turn + 0.5) + 0.01 * sway(FPS * times, random),
        "z": tall_m(body) - 0.042 - 0.020 * np.cos(2.0 * turn - 0.5) - 0.004 * ring,
        "yaw": TURNED_DEG + 6.0 * np.cos(turn + 0.2),
        "pitch": 5.0 + 1.5 * np.sin(2.0 * turn),
        "roll": 4.0 * np.sin(turn + 0.4),
    }
    trunk = {
        "pitch": 2.0 + 1.5 * np.sin(2.0 * turn + 1.5) - ring,
        "roll": -4.0 * np.sin(turn + 0.4) + driven({0.5: 0, 0.9: -7, 2.6: -7, 3.0: 0}, times),
        "yaw": -11.0 * np.cos(turn + 0.2) + driven({0.4: 0, 0.9: 22, 2.5: 26, 3.0: 6}, times),
        "neck_yaw": driven({0.3: 0, 0.7: 44, 2.4: 58, 2.9: 8}, times, 3.5, 0.7),
        "neck_roll": 3.0 * np.sin(turn),
    }
    waving = driven({0.35: 0, 0.75: 1, 2.55: 1, 2.95: 0}, times, 3.5, 0.65)
    shake = sprung(np.sin(2.0 * np.pi * uneven_phases(times, 0.33, 0.10, random)), times, 6.0, 0.6)
    left, right = sprung(-np.cos(turn), times, 4.0, 0.7), sprung(np.cos(turn), times, 4.0, 0.7)
    arms = {
        "L": arm(
            times, SWINGING, ((1.0 - waving) * left, {"elevation": 26, "flexion": 34}), (waving, WAVING)
        ),
        "R": arm(times, SWINGING, (right, {"elevation": 30, "flexion": 40})),
    }
    arms["L"]["flexion"] = arms["L"]["flexion"] + 24.0 * waving * shake
    arms["L"]["twist"] = arms["L"]["twist"] + 22.0 * waving * shake
    feet = {}
    for side, start, aside in (("L", 0.0, -ASIDE_M), ("R", 0.5, ASIDE_M)):
        own = phases + start
        share = np.clip((own % 1.0 - SWING) / (1.0 - SWING), 0.0, 1.0)
        ahead = STRIDE_M * (np.floor(own) + share**2 * (3.0 - 2.0 * share) - start) - START_M
        ahead = ahead + 0.31 * STRIDE_M
        place = np.stack([-ahead, np.full(len(times), aside)], axis=-1)
        yaw = TURNED_DEG + (6.0 if side == "L" else -8.0)
        feet[side] = foot(place, yaw, cyclic(own % 1.0, PITCH), cyclic(own % 1.0, LIFT_M).clip(0.0))
    return choreography(times, random, pelvis, trunk, arms, feet)
