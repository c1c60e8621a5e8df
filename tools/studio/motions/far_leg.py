"""Striding on a treadmill, to be seen exactly from the side: one leg swings past behind the other.

The curves of the feet are drawn after those of fast walking in Winter (2009), *Biomechanics and Motor Control
of Human Movement*.
"""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import cyclic, shock, sprung, sway, uneven_phases
from ..performance import FPS, Choreography
from ..standing import arm, choreography, foot, tall_m

STRIDE_S, STRIDE_M, UNEVENNESS = 0.94, 1.36, 0.025
SWING = 0.60
"""Share of the stride after which a foot swings."""
ASIDE_M = 0.062
AHEAD_M = 0.42
"""Where a heel strikes, before the hips."""
PITCH = {0.0: -21, 0.06: -7, 0.12: 0, 0.32: 0, 0.45: 15, 0.56: 44, 0.62: 58, 0.75: 28, 0.87: -11, 0.95: -21}
LIFT_M = {0.0: 0.0, 0.60: 0.0, 0.69: 0.03, 0.80: 0.035, 0.92: 0.022}
SWINGING = {"elevation": 3, "forward": 92, "rotation": -4, "flexion": 40, "pronation": 15, "girdle": 2}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion; heels strike at whole and half cycles."""
    phases = uneven_phases(times, STRIDE_S, UNEVENNESS, random)
    turn = 2.0 * np.pi * phases
    drift = 0.03 * sway(FPS * times, random, (50.0, 110.0))
    strikes = [float(np.interp(half / 2.0, phases, times)) for half in range(1, int(2 * phases[-1]) + 1)]
    ring = shock(times, strikes, 6.0, 0.08)
    pelvis = {
        "x": 0.02 * np.sin(turn + 0.5),
        "y": drift - 0.014 * np.sin(2.0 * turn + 0.6),
        "z": tall_m(body) - 0.050 - 0.024 * np.cos(2.0 * turn - 0.5) - 0.004 * ring,
        "yaw": -8.0 * np.cos(turn + 0.2),
        "pitch": 6.0 + 1.5 * np.sin(2.0 * turn),
        "roll": -5.0 * np.sin(turn + 0.4),
    }
    trunk = {
        "pitch": 3.0 + 2.0 * np.sin(2.0 * turn + 1.5) - ring,
        "roll": 5.0 * np.sin(turn + 0.4),
        "yaw": 16.0 * np.cos(turn + 0.2) + 2.0 * sway(FPS * times, random),
        "neck_yaw": -9.0 * np.cos(turn + 0.2) + 8.0 * sway(FPS * times, random, (30.0, 80.0)),
        "neck_pitch": -5.0 + 4.0 * sway(FPS * times, random, (30.0, 80.0)),
    }
    arms = {}
    for side, sign in (("L", -1.0), ("R", 1.0)):
        swing = sprung(sign * np.cos(turn + 0.1), times, 4.5, 0.65)
        arms[side] = arm(
            times, SWINGING, (swing, {"elevation": 36, "forward": 76, "flexion": 62, "rotation": 6})
        )
    feet = {}
    for side, start, aside in (("L", 0.0, ASIDE_M), ("R", 0.5, -ASIDE_M)):
        own = phases + start
        share = np.clip((own % 1.0 - SWING) / (1.0 - SWING), 0.0, 1.0)
        ahead = AHEAD_M + STRIDE_M * (np.floor(own) + share**2 * (3.0 - 2.0 * share) - own)
        wander = 0.006 * sway(FPS * times, random, (30.0, 70.0))
        place = np.stack([aside + wander, -ahead], axis=-1)
        yaw = 6.0 if side == "L" else -9.0
        feet[side] = foot(place, yaw, cyclic(own % 1.0, PITCH), cyclic(own % 1.0, LIFT_M).clip(0.0))
    return choreography(times, random, pelvis, trunk, arms, feet)
