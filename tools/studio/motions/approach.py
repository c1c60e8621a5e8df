"""Running toward the camera: short contacts, flight between them, the hips' speed a little uneven.

Joint angles of the leg in the air are drawn after those of slow running in Novacheck (1998), *The
biomechanics of running*.
"""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, cyclic, flight, shock, sprung, sway, uneven_phases
from ..performance import FPS, Choreography
from ..standing import arm, choreography, foot, free, tall_m

STRIDE_S, STRIDE_M, UNEVENNESS = 0.68, 1.44, 0.03
TOE_OFF = 0.36
"""Share of the stride after which a foot leaves the floor."""
START_M = 1.25
AHEAD_M = 0.25
"""Where a foot lands, before the hips."""
ASIDE_M = 0.08
HIP = {0.0: 30, 0.10: 25, 0.22: 10, 0.36: -10, 0.44: -12, 0.58: 14, 0.72: 42, 0.82: 48, 0.92: 38}
KNEE = {0.0: 22, 0.08: 34, 0.15: 42, 0.26: 36, 0.36: 42, 0.45: 58, 0.55: 88, 0.64: 104, 0.76: 78, 0.88: 30}
ANKLE = {0.0: -4, 0.08: -12, 0.2: -24, 0.30: -6, 0.38: 24, 0.5: 12, 0.7: -6, 0.9: -6}
PITCH = {0.0: -6, 0.05: 0, 0.15: 2, 0.24: 8, 0.30: 18, 0.36: 34, 0.6: 50, 0.85: 0}
RUNNING = {"elevation": 4, "forward": 92, "rotation": 4, "flexion": 92, "pronation": 20, "girdle": 4}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion, along -Y."""
    phases = uneven_phases(times, STRIDE_S, UNEVENNESS, random) + 0.1
    turn = 2.0 * np.pi * phases
    run = STRIDE_M * phases - START_M
    first = int(np.ceil(2.0 * phases[0])) - 1
    strikes = {
        half: float(np.interp(half / 2.0, phases, times)) for half in range(first, int(2.0 * phases[-1]) + 2)
    }
    rise, sink = np.zeros(len(times)), np.zeros(len(times))
    for half, strike in strikes.items():
        leaves = float(np.interp(half / 2.0 + TOE_OFF, phases, times))
        following = float(np.interp(half / 2.0 + 0.5, phases, times))
        if leaves > strike:
            rise += flight(times, leaves, following) if following > leaves else 0.0
            sink += burst(times, strike, 0.5 * (strike + leaves), leaves)
    ring = shock(times, list(strikes.values()))
    wander = 0.02 * sway(FPS * times, random, (40.0, 90.0))
    pelvis = {
        "x": 0.016 * np.sin(turn + 0.4) + wander,
        "y": -(run + 0.010 * np.sin(2.0 * turn)),
        "z": tall_m(body) - 0.052 + rise - 0.045 * sprung(sink, times, 9.0, 0.9) - 0.004 * ring,
        "yaw": -9.0 * np.cos(turn + 0.3),
        "pitch": 8.0 + 2.0 * np.sin(2.0 * turn + 1.0) + ring,
        "roll": -5.0 * np.sin(turn + 0.7),
    }
    vigor = 1.0 + 0.06 * sway(FPS * times, random, (25.0, 70.0))
    trunk = {
        "pitch": 4.0 + 2.5 * np.sin(2.0 * turn + 2.4) - ring,
        "roll": 6.0 * np.sin(turn + 0.6),
        "yaw": 20.0 * vigor * np.cos(turn + 0.2),
        "neck_pitch": -9.0 + 2.0 * ring,
        "neck_yaw": -11.0 * np.cos(turn + 0.2) + 7.0 * sway(FPS * times, random, (30.0, 70.0)),
    }
    arms, feet, legs = {}, {}, {}
    for side, start, out in (("L", 0.0, 1.0), ("R", 0.5, -1.0)):
        swing = sprung(-out * vigor * np.cos(turn + 0.2), times, 5.0, 0.6)
        arms[side] = arm(
            times,
            RUNNING,
            (swing, {"elevation": 38, "forward": 76, "flexion": 106, "rotation": 18, "girdle": 7}),
        )
        own = phases + start
        within = own % 1.0
        landed = AHEAD_M + STRIDE_M * (np.floor(own) - start) - START_M
        ahead = landed + STRIDE_M * np.clip((within - TOE_OFF) / (1.0 - TOE_OFF), 0.0, 1.0)
        place = np.stack([out * ASIDE_M + 0.7 * wander, -ahead], axis=-1)
        lift = 0.10 * np.sin(np.pi * np.clip((within - TOE_OFF) / (1.0 - TOE_OFF), 0.0, 1.0))
        feet[side] = foot(place, out * 7.0, cyclic(within, PITCH), lift)
        share = np.clip(np.minimum((within - TOE_OFF) / 0.18, (1.0 - within) / 0.14), 0.0, 1.0)
        legs[side] = free(times, share**2 * (3.0 - 2.0 * share), {"outward": 0.0, "twist": 6.0})
        legs[side].flexion[:] = vigor * cyclic(within, HIP)
        legs[side].knee[:] = vigor * cyclic(within, KNEE)
        legs[side].ankle[:] = cyclic(within, ANKLE)
    return choreography(times, random, pelvis, trunk, arms, feet, legs)
