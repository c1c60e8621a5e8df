"""Jogging on a treadmill: joint angles over the stride, flight after each toe-off, feet that slide back.

The curves are drawn after those of slow running in Novacheck (1998), *The biomechanics of running*.
"""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import cyclic, flight, shock, sprung, sway, uneven_phases
from ..performance import FPS, Choreography
from ..standing import arm, choreography, free

STRIDE_S, UNEVENNESS = 0.70, 0.045
TOE_OFF = 0.37
"""Share of the stride after which a foot leaves the belt."""
RIGHT_SHARE = 0.94
"""Amplitude of the right leg's swing relative to the left, an uneven gait."""
HIP = {0.0: 34, 0.10: 27, 0.22: 10, 0.36: -9, 0.44: -11, 0.58: 12, 0.72: 41, 0.82: 48, 0.92: 41}
KNEE = {0.0: 17, 0.08: 33, 0.15: 42, 0.26: 31, 0.36: 17, 0.45: 38, 0.55: 84, 0.64: 104, 0.76: 76, 0.88: 27}
ANKLE = {0.0: -4, 0.08: -12, 0.2: -24, 0.30: -6, 0.38: 24, 0.5: 12, 0.7: -6, 0.9: -2}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    phases = uneven_phases(times, STRIDE_S, UNEVENNESS, random)
    vigor = 1.0 + 0.07 * sway(FPS * times, random, (25.0, 70.0))
    legs = {}
    for side, start in (("L", 0.0), ("R", 0.5)):
        own = phases + start + 0.012 * sway(FPS * times, random, (12.0, 40.0))
        vigor_here = vigor if side == "L" else RIGHT_SHARE * vigor
        legs[side] = free(times, np.ones(len(times)), {"outward": 0.0, "twist": 6.0})
        legs[side].flexion[:] = vigor_here * cyclic(own, HIP)
        legs[side].knee[:] = vigor_here * cyclic(own, KNEE)
        legs[side].ankle[:] = cyclic(own, ANKLE)
    strikes = [_time_of(phases, times, half / 2.0) for half in _whole(2.0 * phases)]
    height = sum(
        flight(times, strike + (TOE_OFF - 0.01) * STRIDE_S, strike + 0.5 * STRIDE_S) for strike in strikes
    )
    ring = shock(times, strikes)
    turn = 2.0 * np.pi * phases
    pelvis = {
        "x": 0.02 * np.sin(turn + 0.4) + 0.03 * sway(FPS * times, random, (50.0, 120.0)),
        "y": 0.06 * sway(FPS * times, random, (40.0, 90.0)) + 0.012 * np.sin(2.0 * turn),
        "yaw": 8.0 * np.cos(turn + 0.5) + 3.0 * sway(FPS * times, random, (40.0, 90.0)),
        "pitch": 9.0 + 2.0 * np.sin(2.0 * turn + 1.0) + 1.5 * ring,
        "roll": 5.0 * np.sin(turn + 0.9),
    }
    trunk = {
        "pitch": 3.0 + 2.5 * np.sin(2.0 * turn + 2.4) - 1.5 * ring,
        "roll": -6.0 * np.sin(turn + 0.7),
        "yaw": -20.0 * vigor * np.cos(turn + 0.3),
        "neck_pitch": -10.0 + 2.0 * ring,
        "neck_yaw": 12.0 * np.cos(turn + 0.3) + 9.0 * sway(FPS * times, random, (30.0, 70.0)),
    }
    arms = {}
    for side, sign in (("L", -1.0), ("R", 1.0)):
        swing = sprung(vigor * np.cos(turn + 0.35) * sign, times, 5.0, 0.6)
        channels = arm(
            times,
            {"elevation": 4, "forward": 72, "rotation": 24, "flexion": 88, "pronation": 20, "girdle": 5},
            (swing, {"elevation": 38, "flexion": 104, "rotation": 34, "girdle": 8}),
        )
        arms[side] = channels
    return choreography(times, random, pelvis, trunk, arms, free_legs=legs, grounded=np.asarray(height))


def _whole(values: Array) -> Array:
    """The integers that `values` pass."""
    return np.arange(np.ceil(values[0]), np.floor(values[-1]) + 1.0)


def _time_of(phases: Array, times: Array, phase: float) -> float:
    return float(np.interp(phase, phases, times))
