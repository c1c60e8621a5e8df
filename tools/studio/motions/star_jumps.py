"""Jumping jacks: feet apart and together in low flights, arms overhead and down, no two alike."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import cyclic, flight, shock, sprung, sway, uneven_phases
from ..performance import FPS, Choreography
from ..standing import arm, choreography, foot, tall_m

PERIOD_S, UNEVENNESS = 0.98, 0.06
FLIGHTS = ((0.14, 0.40), (0.64, 0.89))
"""Shares of the period between takeoff and landing: outward, then inward."""
APART = {0.0: 0.0, 0.13: 0.0, 0.28: 0.6, 0.40: 1.0, 0.63: 1.0, 0.77: 0.45, 0.89: 0.0}
DROP_M = {0.0: 0.075, 0.07: 0.085, 0.14: -0.055, 0.40: 0.03, 0.49: 0.12, 0.64: -0.0, 0.89: -0.03, 0.95: 0.05}
ON_TOES_DEG = {
    0.0: 4,
    0.06: 2,
    0.14: 44,
    0.27: 48,
    0.40: 26,
    0.47: 4,
    0.55: 2,
    0.64: 38,
    0.77: 44,
    0.89: 28,
    0.95: 8,
}
ELEVATION = {0.0: 10, 0.10: 12, 0.22: 66, 0.36: 142, 0.46: 160, 0.58: 150, 0.72: 82, 0.86: 22}
ELBOW = {0.0: 14, 0.16: 48, 0.30: 34, 0.46: 16, 0.60: 42, 0.74: 58, 0.9: 20}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    phases = uneven_phases(times, PERIOD_S, UNEVENNESS, random)
    vigor = 1.0 + 0.09 * sway(FPS * times, random, (20.0, 60.0))
    height, landings = np.zeros(len(times)), []
    for cycle in np.arange(np.floor(phases[0]), np.ceil(phases[-1])):
        for off, on in FLIGHTS:
            start, end = (float(np.interp(cycle + share, phases, times)) for share in (off, on))
            if end > start:
                height = height + flight(times, start, end)
                landings.append(end)
    ring = shock(times, landings)
    turn = 2.0 * np.pi * phases
    wander = 0.03 * sway(FPS * times, random, (40.0, 90.0))
    pelvis = {
        "x": wander,
        "y": 0.02 * np.sin(turn) + 0.03 * sway(FPS * times, random, (40.0, 90.0)),
        "z": tall_m(body) - 0.02 + height - cyclic(phases, DROP_M) - 0.012 * ring,
        "yaw": 7.0 * sway(FPS * times, random, (30.0, 70.0)),
        "pitch": 5.0 + 5.0 * np.cos(2.0 * turn - 0.8) + 2.0 * ring,
        "roll": 2.0 * np.sin(turn) + 2.0 * ring * np.sin(0.5 * turn),
    }
    trunk = {
        "pitch": 4.0 + 6.0 * np.cos(2.0 * turn - 1.2) - 3.0 * np.cos(turn),
        "roll": -4.0 * np.sin(turn + 1.0),
        "yaw": 6.0 * sway(FPS * times, random, (20.0, 50.0)),
        "neck_pitch": -5.0 + 4.0 * ring,
        "neck_yaw": 14.0 * sway(FPS * times, random, (30.0, 60.0)),
    }
    arms, feet = {}, {}
    for side, out, late in (("L", 1.0, 0.0), ("R", -1.0, 0.025)):
        own = phases - late + 0.012 * sway(FPS * times, random, (12.0, 40.0))
        channels = arm(times, {"forward": 16.0, "rotation": 10.0, "pronation": 10.0})
        channels["elevation"] = sprung(vigor.clip(None, 1.03) * cyclic(own, ELEVATION), times, 6.0, 0.7)
        channels["flexion"] = sprung(vigor * cyclic(own, ELBOW), times, 6.0, 0.7)
        channels["girdle"] = 0.15 * channels["elevation"]
        channels["forward"] = channels["forward"] + 10.0 * sway(FPS * times, random, (15.0, 40.0))
        arms[side] = channels
        place = np.stack([wander + out * (0.085 + 0.27 * vigor * cyclic(own, APART)), 0.0 * times], axis=-1)
        place[:, 1] += 0.03 * sway(FPS * times, random, (14.0, 30.0))
        feet[side] = foot(place, out * 10.0 + pelvis["yaw"], cyclic(phases, ON_TOES_DEG), 0.92 * height)
    return choreography(times, random, pelvis, trunk, arms, feet)
