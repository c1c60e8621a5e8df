"""Walking up to a bar, ducking under it with bent knees and a hand ahead, and straightening up beyond."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, shock, sprung
from ..performance import Choreography
from ..standing import arm, choreography, foot, stepped, tall_m

TURNED_DEG = -90.0
"""The way is along -X."""
LANDINGS_S = (0.30, 0.78, 1.22, 1.70, 2.16, 2.62)
PLACES_M = (-0.62, -0.16, 0.22, 0.58, 1.02, 1.08)
"""Where a heel lands along the way, left foot first."""
SWING_S = 0.36
ASIDE_M = 0.085
UNDER_S = 1.42
"""When the head is below the bar."""
EASY = {"elevation": 8, "forward": 70, "rotation": 8, "flexion": 34, "pronation": 15, "girdle": 1}
FEELING = {"elevation": 78, "forward": 80, "rotation": 26, "flexion": 40, "pronation": 40, "girdle": 10}
BALANCE = {"elevation": 58, "forward": -14, "rotation": -4, "flexion": 50, "pronation": 10, "girdle": 2}
BEHIND = {"elevation": 26, "forward": -40, "rotation": 0, "flexion": 30, "pronation": 10, "girdle": -2}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    down = driven(
        {0.12: 0, 0.42: 0.5, 0.74: 1.02, UNDER_S: 1.0, 1.66: 0.9, 2.0: 0.36, 2.3: 0.0}, times, 3.6, 0.8
    )
    ring = shock(times, list(LANDINGS_S), 6.0, 0.08)
    along = driven(
        {-0.2: -1.00, 0.30: -0.72, 0.78: -0.36, 1.22: 0.06, UNDER_S: 0.20, 1.70: 0.46, 2.16: 0.84, 2.62: 1.06,
         2.9: 1.09}, times, 3.0, 0.95)  # fmt: skip
    swing = driven({-0.2: -1, 0.30: 1, 0.78: -1, 1.22: 0.5, 1.70: -0.5, 2.16: 0.9, 2.62: 0}, times, 4.0, 0.8)
    pelvis = {
        "x": -along,
        "y": driven({0.30: -0.02, 0.78: 0.02, 1.22: -0.03, 1.7: 0.02, 2.16: -0.02, 2.6: 0.0}, times, 3.0),
        "z": tall_m(body) - 0.05 - 0.30 * down - 0.006 * ring,
        "yaw": TURNED_DEG + 6.0 * swing + 10.0 * down,
        "pitch": 4.0 + 34.0 * down + ring,
        "roll": 3.0 * swing,
    }
    trunk = {
        "pitch": 3.0 + 38.0 * down + 3.0 * burst(times, 1.9, 2.2, 2.6) - ring,
        "roll": -4.0 * swing - 12.0 * burst(times, 1.0, UNDER_S, 1.8),
        "yaw": -9.0 * swing + 8.0 * down,
        "neck_pitch": driven({0.1: 4, 0.6: -26, 0.9: -8, UNDER_S: 6, 1.7: -22, 2.3: 2}, times, 4.0, 0.75),
        "neck_yaw": driven({0.5: 0, 1.6: 8, 2.0: 34, 2.5: 20}, times, 4.0, 0.75),
    }
    feeling = driven({0.2: 0, 0.6: 1, 0.9: 0.9, 1.4: 0.3, 1.9: 0.1}, times, 4.5, 0.65)
    balance = sprung(down, times, 4.0, 0.7)
    arms = {
        "L": arm(
            times, EASY, (feeling, FEELING), (-0.5 * swing * (1.0 - down), BEHIND), (0.5 * balance, BALANCE)
        ),
        "R": arm(times, EASY, (0.9 * balance, BALANCE), (0.6 * swing * (1.0 - down), BEHIND)),
    }
    return choreography(times, random, pelvis, trunk, arms, _feet(times, down))


def _feet(times: Array, down: Array) -> dict[str, tuple[Array, Array]]:
    """Six steps; heels rise early while the knees are bent."""
    feet = {}
    for side, out, start, first in (("L", -1.0, -1.34, 0), ("R", 1.0, -0.98, 1)):
        aside = out * ASIDE_M
        steps = [
            (at - SWING_S, at, (-place, aside))
            for at, place in zip(LANDINGS_S[first::2], PLACES_M[first::2], strict=True)
        ]
        places, lifted = stepped(times, (-start, aside), steps)
        push = sum(burst(times, lifts - 0.20, lifts + 0.05, lifts + 0.22) for lifts, _, _ in steps)
        strike = sum(burst(times, lands - 0.14, lands - 0.02, lands + 0.08) for _, lands, _ in steps)
        pitch = 3.0 + 34.0 * push - 12.0 * strike * (1.0 - down)
        yaw = TURNED_DEG + (8.0 if side == "L" else -8.0)
        feet[side] = foot(places, yaw, pitch, 0.05 * lifted)
    return feet
