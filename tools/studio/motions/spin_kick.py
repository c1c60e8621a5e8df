"""A spinning kick: a step, nearly a full turn on the ball of the front foot, the rear leg flung out behind.

The head is turned ahead of the body to find the target; the arms come in while the turn is fast and open as
the leg does; the kicking foot lands behind again and the body sways out the rest of the turn.
"""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, keyed, shock
from ..limbs import FreeLeg
from ..performance import Choreography
from ..standing import arm, choreography, foot, free, stepped, tall_m

TURN_S, LANDED_S = 0.76, 1.62
"""Begin and end of the turn."""
KICK_S = 1.27
"""Time of full extension."""
LIFTS_S = 0.84
"""The rear foot leaves the floor."""
GUARD = {"elevation": 32, "forward": 56, "rotation": 26, "flexion": 116, "pronation": 25, "girdle": 3}
OPEN = {"elevation": 62, "forward": 10, "rotation": 4, "flexion": 46, "pronation": 10, "girdle": 5}
WOUND = {"elevation": 52, "forward": 96, "rotation": 46, "flexion": 84, "pronation": 30, "girdle": 6}
BALL_M = 0.145
"""From the ankle to the ball of the foot, about which it turns."""


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    turn, landed, kick = TURN_S, LANDED_S, KICK_S
    yaw = driven(
        {0.0: -30, 0.36: -30, 0.62: -14, turn - 0.02: -16, 0.92: -76, 1.06: -158, 1.20: -226,
         kick + 0.05: -262, 1.46: -306, landed: -334, 1.84: -384, 2.05: -398, 2.5: -392},
        times, 6.0, 0.75)  # fmt: skip
    support = driven(
        {0.0: -6, 0.3: -8, 0.5: -34, turn: -40, 0.98: -120, 1.20: -206, kick + 0.06: -236, 1.5: -280,
         landed + 0.05: -324, 1.95: -368, 2.5: -366}, times, 6.0, 0.8)  # fmt: skip
    up = keyed({turn - 0.06: 0, turn + 0.08: 1, 1.52: 1, landed + 0.06: 0.15, 2.0: 0.1}, times)
    ball = np.array([0.05, -0.40]) + np.outer(keyed({0.16: 0, 0.44: 1}, times), [0.03, -0.12])
    ring = shock(times, [0.44, landed])
    feet = _feet(times, ball, support, up)
    on_left = driven({0.2: 0, 0.5: 0.45, turn + 0.08: 0.94, 1.3: 1.0, 1.5: 0.8,
                      landed + 0.02: 0.42, 2.1: 0.5}, times, 5.0, 0.9)  # fmt: skip
    over = feet["L"][0][:, :2] + 0.5 * body.actor.segments_m["hip_width"] * _toward(yaw - 90.0)
    between = np.stack(
        [driven({0.0: 0.0, 0.5: 0.02, landed: 0.02, 2.4: 0.0}, times, 3.0),
         driven({0.0: 0.0, 0.5: -0.12, landed: -0.16, 2.4: -0.14}, times, 3.0)], axis=-1)  # fmt: skip
    place = over * on_left[:, None] + between * (1.0 - on_left[:, None])
    drop = driven(
        {0.0: 0.08, 0.3: 0.09, 0.62: 0.17, turn + 0.04: 0.12, 1.0: 0.045, kick: 0.04, 1.46: 0.07,
         landed + 0.06: 0.17, 1.9: 0.12, 2.5: 0.085}, times, 4.5, 0.7)  # fmt: skip
    lean = driven({0.9: 0, 1.12: 18, kick: 34, kick + 0.08: 33, 1.46: 12, landed + 0.04: -3, 2.1: 0}, times)
    pelvis = {
        "x": place[:, 0],
        "y": place[:, 1],
        "z": tall_m(body) - drop - 0.012 * ring,
        "yaw": yaw,
        "pitch": driven({0.0: 4, 0.6: 10, 1.0: 6, kick: 8, landed + 0.08: 12, 2.2: 4}, times),
        "roll": lean,
    }
    trunk = {
        "pitch": driven({0.0: 8, 0.6: 15, 1.05: 12, kick: 14, landed + 0.1: 18, 2.2: 9}, times) + 3.0 * ring,
        "roll": driven({0.9: 0, kick: 16, 1.5: 4, landed + 0.1: -6, 2.2: 0}, times),
        "yaw": driven({0.0: -4, 0.4: -4, 0.64: 24, 0.80: 6, 0.98: -28, 1.14: -22, kick + 0.02: 14, 1.5: 20,
                       1.8: -14, 2.3: -4}, times, 6.0, 0.6),
        "neck_yaw": driven({0.0: 28, 0.5: 16, 0.74: 24, 0.90: -48, 1.12: -66, kick: -58, 1.46: -30,
                            landed: 6, 1.9: 40, 2.4: 28}, times, 6.0, 0.8),
        "neck_pitch": driven({0.0: -6, kick: 4, landed + 0.1: -10, 2.2: -6}, times),
        "neck_roll": driven({0.95: 0, kick: -18, 1.6: 0}, times),
    }  # fmt: skip
    wound = keyed({0.36: 0, 0.64: 1, 0.86: 0}, times)
    opened = driven({0.98: 0, kick: 1, 1.42: 0.9, 1.76: 0.2, 2.2: 0}, times, 5.0, 0.6)
    caught = burst(times, landed - 0.1, landed + 0.14, landed + 0.6)
    arms = {
        "L": arm(times, GUARD, (0.7 * wound, OPEN), (0.9 * opened, OPEN), (0.35 * caught, WOUND)),
        "R": arm(times, GUARD, (0.75 * wound, WOUND), (opened, OPEN), (0.7 * caught, OPEN)),
    }
    return choreography(times, random, pelvis, trunk, arms, feet, {"R": _kicking(times)})


def _toward(yaw: Array) -> Array:
    """(T, 2) the direction of toes that are turned left by `yaw` from -Y [degrees]."""
    return np.stack([np.sin(np.radians(yaw)), -np.cos(np.radians(yaw))], axis=-1)


def _feet(times: Array, ball: Array, support: Array, up: Array) -> dict[str, tuple[Array, Array]]:
    """The left foot on its ball; the right one before its flight and after it."""
    step = burst(times, 0.16, 0.32, 0.44)
    left = foot(ball - BALL_M * _toward(support), support, 13.0 * up + 10.0 * step, 0.03 * step)
    places, lifted = stepped(
        times, (-0.15, 0.16), [(LIFTS_S, LANDED_S, (-0.06, 0.20)), (1.78, 1.98, (-0.15, 0.14))]
    )
    yaw = driven({0.0: -62, 0.5: -62, LIFTS_S: -80, LIFTS_S + 0.2: -380, LANDED_S: -392, 2.1: -420}, times)
    push = 26.0 * burst(times, 0.6, LIFTS_S, LIFTS_S + 0.16)
    return {"L": left, "R": foot(places, yaw, 10.0 + push + 8.0 * lifted, 0.03 * lifted)}


def _kicking(times: Array) -> FreeLeg:
    """The right leg: knee drawn up beside the body, flung out, hooked back, let down."""
    at = KICK_S
    share = driven(
        {LIFTS_S - 0.04: 0, LIFTS_S + 0.09: 1, LANDED_S - 0.21: 1, LANDED_S - 0.03: 0}, times, 9.0, 1.0
    )
    leg = free(times, share, {})
    leg.flexion[:] = driven(
        {LIFTS_S: 14, 1.04: 64, at - 0.10: 84, at: 78, at + 0.12: 66, LANDED_S - 0.12: 46, LANDED_S: 34},
        times, 6.0, 0.65)  # fmt: skip
    leg.outward[:] = driven(
        {LIFTS_S: 10, 1.04: 32, at - 0.10: 50, at: 66, at + 0.14: 70, LANDED_S - 0.1: 40, LANDED_S: 12},
        times, 6.0, 0.75)  # fmt: skip
    leg.twist[:] = driven({LIFTS_S: 6, at - 0.1: 0, at: -10, LANDED_S: 4}, times)
    leg.knee[:] = driven(
        {LIFTS_S - 0.02: 76, 1.02: 108, at - 0.12: 102, at: 12, at + 0.05: 12, at + 0.17: 84,
         LANDED_S - 0.1: 80, LANDED_S + 0.04: 62}, times, 8.0, 0.6)  # fmt: skip
    leg.ankle[:] = driven({LIFTS_S: 8, 1.05: 4, at: 8, LANDED_S: 6}, times)
    return leg
