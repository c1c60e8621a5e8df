"""A full turn on one leg: winding up, arms flung out and drawn in, a stumble, and half a turn back."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, keyed, shock
from ..limbs import FreeLeg
from ..performance import Choreography
from ..standing import arm, choreography, free

START_S, END_S = 0.58, 1.36
BACK_S = (1.95, 2.45)
BESIDE = {"elevation": 34, "forward": 35, "rotation": 20, "flexion": 38, "pronation": 20, "girdle": 2}
OUT = {"elevation": 92, "forward": 18, "rotation": 12, "flexion": 16, "pronation": -20, "girdle": 10}
ACROSS = {"elevation": 66, "forward": 102, "rotation": 62, "flexion": 72, "pronation": 30, "girdle": 6}
HIGH = {"elevation": 142, "forward": 40, "rotation": 10, "flexion": 48, "girdle": 20}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    yaw = driven(
        {0.0: 4, 0.20: 2, 0.46: -48, START_S: -44, 0.80: 62, 1.0: 196, 1.18: 312, END_S: 372, 1.6: 366,
         BACK_S[0] - 0.12: 384, BACK_S[0]: 372, 2.2: 268, BACK_S[1]: 192, 3.0: 198},
        times, 5.5, 0.7)  # fmt: skip
    trunk_lead = driven(
        {0.1: 0, 0.44: -30, 0.60: 6, 0.78: 26, 1.05: 6, END_S: -16, 1.58: 4, BACK_S[0] - 0.1: 22, 2.12: -28,
         BACK_S[1] + 0.05: 14, 2.9: 0}, times)  # fmt: skip
    # The head looks to the front as long as the neck allows, then overtakes the turn.
    neck = driven(
        {0.1: 0, 0.46: 58, 0.72: -20, 0.90: -66, 1.04: -40, 1.16: 62, END_S: 8, BACK_S[0]: -10, 2.1: 52,
         2.24: -50, BACK_S[1]: 6}, times, 6.0, 0.8)  # fmt: skip
    stumble = burst(times, END_S, END_S + 0.12, END_S + 0.5)
    ring = shock(times, [END_S, BACK_S[1]], 5.0, 0.1)
    pelvis = {
        "x": driven(
            {0.3: 0.0, START_S: 0.05, 1.0: 0.10, END_S: 0.05, 1.7: 0.0, 2.2: -0.10, 2.9: -0.07}, times, 3.0
        ),
        "y": driven({0.4: 0.03, 0.9: -0.05, 1.2: 0.04, END_S + 0.1: 0.09, 1.8: 0.0, 2.3: -0.06}, times, 3.0),
        "yaw": yaw,
        "pitch": 3.0 + driven({0.2: 0, 0.45: 9, 0.8: -4, END_S + 0.1: 5, 2.0: 2, 2.3: -4, 2.6: 5}, times),
        "roll": 7.0 * burst(times, 0.6, 0.95, 1.3) - 8.0 * stumble + 2.0 * ring,
    }
    trunk = {
        "pitch": 3.0 + driven({0.2: 0, 0.48: 10, 0.85: -6, END_S + 0.15: 9, 1.9: 0}, times) + 3.0 * ring,
        "roll": -6.0 * burst(times, 0.6, 0.95, 1.3) + 14.0 * stumble - 8.0 * burst(times, 1.95, 2.2, 2.6),
        "yaw": trunk_lead,
        "neck_yaw": neck,
        "neck_pitch": -4.0 - 6.0 * stumble,
    }
    wound = keyed({0.15: 0, 0.46: 1, 0.66: 0}, times)
    flung = driven({0.5: 0, 0.72: 1, 0.86: 0.85, 1.02: 0.1, 1.14: 0.1, END_S + 0.06: 1, 1.75: 0.2, 2.0: 0,
                    2.2: 0.7,
                    BACK_S[1] + 0.1: 0.9, 2.95: 0.1}, times, 4.5, 0.55)  # fmt: skip
    tight = driven({0.78: 0, 1.0: 1, 1.14: 1, END_S: 0}, times)
    arms = {
        "L": arm(times, BESIDE, (wound, ACROSS), (flung, OUT), (0.9 * tight, ACROSS), (0.6 * stumble, HIGH)),
        "R": arm(
            times, BESIDE, (0.8 * wound, OUT), (0.9 * flung, OUT), (tight, ACROSS), (0.9 * stumble, OUT)
        ),
    }
    return choreography(
        times, random, pelvis, trunk, arms, free_legs=_legs(times, stumble), grounded=np.zeros(len(times))
    )


def _legs(times: Array, stumble: Array) -> dict[str, FreeLeg]:
    always = np.ones(len(times))
    standing = free(times, always, {"outward": 0, "ankle": 0})
    wind = driven({0.15: 0, 0.46: 1, 0.66: 0}, times)
    bend = driven({0.1: 0.3, 0.46: 1.15, 0.66: 0.25, 1.1: 0.12, END_S + 0.1: 1.35, 1.7: 0.35, 1.94: 0.9,
                   2.15: 0.2,
                   BACK_S[1] + 0.08: 1.0, 2.9: 0.3}, times)  # fmt: skip
    standing.flexion[:] = 24.0 * bend
    standing.knee[:] = 46.0 * bend
    standing.ankle[:] = -20.0 * bend + 32.0 * keyed(
        {0.56: 0, 0.72: 1, 1.22: 1, END_S: 0, 1.98: 0, 2.1: 0.6, 2.36: 0}, times
    )
    standing.outward[:] = 16.0
    standing.twist[:] = 6.0 + 44.0 * wind - 10.0 * burst(times, BACK_S[0] - 0.2, BACK_S[0], 2.3)
    raised = driven(
        {0.5: 0, 0.74: 0.9, 1.1: 1, 1.24: 0.7, END_S: 0, 1.98: 0, 2.16: 0.55, BACK_S[1] - 0.02: 0}, times
    )
    swinging = free(times, always, {})
    swinging.flexion[:] = 24.0 * bend * (1.0 - raised) + 62.0 * raised + 12.0 * stumble
    swinging.outward[:] = 20.0 + 42.0 * raised + 40.0 * stumble
    swinging.twist[:] = 6.0 - 44.0 * wind + 26.0 * raised
    swinging.knee[:] = 46.0 * bend * (1.0 - raised) + 108.0 * raised
    swinging.ankle[:] = -20.0 * bend * (1.0 - raised) + 34.0 * raised
    return {"L": standing, "R": swinging}
