"""A front kick with the right leg, then a side kick with the left: chamber, snap, recoil, recovery."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, shock
from ..limbs import FreeLeg
from ..performance import Choreography
from ..standing import arm, choreography, foot, free, stepped, tall_m

FRONT_S, SIDE_S = 0.98, 2.24
"""Times of full extension."""
GUARD = {"elevation": 32, "forward": 58, "rotation": 28, "flexion": 122, "pronation": 30, "girdle": 3}
FLUNG = {"elevation": 38, "forward": -28, "rotation": 5, "flexion": 34, "girdle": 0}
REACHING = {"elevation": 74, "forward": 70, "rotation": 30, "flexion": 58, "girdle": 9}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    front, side = FRONT_S, SIDE_S
    off = {"R": (front - 0.42, front + 0.52), "L": (side - 0.44, side + 0.56)}
    landings = {"R": (-0.17, -0.30), "L": (0.20, -0.44)}
    starts = {"L": (0.13, -0.16), "R": (-0.12, 0.20)}
    shuffle = {"L": [(0.12, 0.30, (0.12, -0.20))], "R": [(side - 0.78, side - 0.60, (-0.13, -0.22))]}
    yaws = {
        "L": driven({0.0: 4, front - 0.4: 4, front: 30, front + 0.5: 20, side: -20, side + 0.7: -8}, times),
        "R": driven({0.0: -50, front + 0.4: -30, side - 0.5: -40, side: -132, side + 0.6: -62}, times),
    }
    feet = {}
    for name in ("L", "R"):
        steps = sorted([*shuffle[name], (off[name][0] + 0.1, off[name][1], landings[name])])
        places, lifted = stepped(times, starts[name], steps)
        feet[name] = foot(places, yaws[name], 14.0 * lifted, 0.05 * lifted)
    legs = {"R": _front_leg(times), "L": _side_leg(times)}
    ring = shock(times, [off["R"][1], off["L"][1]])
    drop = driven(
        {-0.1: 0.07, 0.35: 0.10, front - 0.2: 0.03, front: 0.035, front + 0.25: 0.06, front + 0.55: 0.13,
         side - 0.55: 0.11, side - 0.2: 0.05, side: 0.04, side + 0.3: 0.07, side + 0.6: 0.15, 3.4: 0.08},
        times, 4.0, 0.7)  # fmt: skip
    pelvis = {
        "x": driven({0.0: 0.0, front - 0.4: 0.07, front: 0.09, front + 0.5: 0.0, side - 0.4: -0.10,
                     side: -0.09, side + 0.6: 0.04, 3.4: 0.02}, times, 3.0, 0.8),
        "y": driven({0.0: 0.03, front - 0.35: -0.05, front: -0.26, front + 0.3: -0.18, front + 0.6: -0.24,
                     side - 0.3: -0.26, side: -0.34, side + 0.3: -0.27, 3.4: -0.30}, times, 3.5, 0.7),
        "z": tall_m(body) - drop - 0.015 * ring,
        "yaw": driven({0.0: -32, front - 0.35: -20, front: 18, front + 0.3: 10, front + 0.65: 22,
                       side - 0.6: 4, side - 0.15: -72, side: -92, side + 0.25: -80, side + 0.7: -30}, times),
        "pitch": driven({0.0: 4, front - 0.2: -3, front: -16, front + 0.25: -5, front + 0.6: 9,
                         3.4: 4}, times),
        "roll": driven({side - 0.5: 0, side - 0.15: -22, side: -33, side + 0.25: -24, side + 0.6: 4,
                        3.4: 0}, times),
    }  # fmt: skip
    trunk = {
        "pitch": driven({0.0: 8, front - 0.15: 14, front: 4, front + 0.3: 12, side: 8, 3.4: 9}, times)
                 + 3 * ring,
        "roll": driven({side - 0.4: 0, side - 0.1: -12, side: -20, side + 0.3: -12, side + 0.7: 2}, times),
        "yaw": driven({0.0: -6, front - 0.25: -22, front: 14, front + 0.4: -6, side - 0.3: -16, side: 22,
                       side + 0.4: 6, 3.4: -4}, times),
        "neck_yaw": driven({0.0: 30, front: -20, front + 0.6: -12, side - 0.2: 58, side + 0.2: 60,
                            3.4: 34}, times),
        "neck_pitch": driven({0.0: -6, front: 14, front + 0.5: -8, side: 6, 3.4: -4}, times),
        "neck_roll": driven({side - 0.4: 0, side: 22, side + 0.6: 0}, times),
    }  # fmt: skip
    throw = burst(times, front - 0.32, front + 0.02, front + 0.42)
    guard = burst(times, side - 0.45, side - 0.02, side + 0.55)
    arms = {
        "L": arm(times, GUARD, (throw, REACHING), (guard, FLUNG | {"elevation": 66, "forward": 8})),
        "R": arm(
            times, GUARD, (burst(times, front - 0.3, front + 0.07, front + 0.5), FLUNG), (guard, REACHING)
        ),
    }
    return choreography(times, random, pelvis, trunk, arms, feet, legs)


def _front_leg(times: Array) -> FreeLeg:
    at = FRONT_S
    share = driven({at - 0.42: 0, at - 0.28: 1, at + 0.28: 1, at + 0.44: 0}, times, 8.0, 1.0)
    leg = free(times, share, {"outward": 6.0, "twist": 4.0})
    leg.flexion[:] = driven(
        {at - 0.4: 12, at - 0.13: 88, at: 97, at + 0.16: 84, at + 0.5: 36}, times, 6.0, 0.6
    )
    leg.knee[:] = driven(
        {
            at - 0.4: 58,
            at - 0.17: 122,
            at - 0.12: 116,
            at + 0.01: 12,
            at + 0.05: 12,
            at + 0.17: 104,
            at + 0.5: 58,
        },
        times,
        8.0,
        0.55,
    )
    leg.ankle[:] = driven({at - 0.4: 12, at - 0.1: 10, at: 38, at + 0.3: 5}, times)
    return leg


def _side_leg(times: Array) -> FreeLeg:
    at = SIDE_S
    share = driven({at - 0.44: 0, at - 0.30: 1, at + 0.30: 1, at + 0.48: 0}, times, 8.0, 1.0)
    leg = free(times, share, {})
    leg.flexion[:] = driven(
        {at - 0.42: 18, at - 0.14: 86, at: 70, at + 0.2: 82, at + 0.55: 34}, times, 6.0, 0.65
    )
    leg.outward[:] = driven(
        {at - 0.42: 0, at - 0.14: 38, at: 82, at + 0.2: 48, at + 0.55: 8}, times, 6.0, 0.7
    )
    leg.twist[:] = driven({at - 0.42: 6, at - 0.1: -4, at: -14, at + 0.5: 4}, times)
    leg.knee[:] = driven(
        {
            at - 0.42: 56,
            at - 0.16: 118,
            at - 0.11: 110,
            at + 0.01: 10,
            at + 0.06: 14,
            at + 0.22: 100,
            at + 0.55: 62,
        },
        times,
        8.0,
        0.55,
    )
    leg.ankle[:] = driven({at - 0.42: 15, at - 0.1: -12, at + 0.4: -4}, times)
    return leg
