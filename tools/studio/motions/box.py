"""Boxing: jab, cross, hook, a slip and an uppercut, with steps, pivoting heels and a bounce all the time."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, sprung, sway, uneven_phases
from ..performance import FPS, Choreography
from ..standing import arm, choreography, foot, stepped, tall_m

JAB_S, CROSS_S, HOOK_S = 0.46, 0.78, 1.22
SLIP_S, UPPERCUT_S = 1.70, 2.12
LAST_JAB_S, LAST_CROSS_S = 2.86, 3.12
GUARD = {"elevation": 30, "forward": 56, "rotation": 26, "flexion": 128, "pronation": 15, "girdle": 4}
STRAIGHT = {"elevation": 86, "forward": 82, "rotation": 42, "flexion": 9, "pronation": 72, "girdle": 12}
HOOK = {"elevation": 84, "forward": 52, "rotation": 78, "flexion": 88, "pronation": 40, "girdle": 10}
UPPERCUT = {"elevation": 62, "forward": 84, "rotation": 14, "flexion": 96, "pronation": -62, "girdle": 6}
LOADED = {"elevation": 12, "forward": 20, "rotation": 14, "flexion": 104, "pronation": -20, "girdle": 0}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    hops = np.sin(2.0 * np.pi * uneven_phases(times, 0.42, 0.12, random))
    jab, cross = _punch(times, JAB_S), _punch(times, CROSS_S)
    last_jab, last_cross = _punch(times, LAST_JAB_S), _punch(times, LAST_CROSS_S)
    hook = burst(times, HOOK_S - 0.15, HOOK_S, HOOK_S + 0.27)
    slip = burst(times, SLIP_S - 0.2, SLIP_S, SLIP_S + 0.3)
    load = burst(times, UPPERCUT_S - 0.36, UPPERCUT_S - 0.13, UPPERCUT_S + 0.02)
    uppercut = burst(times, UPPERCUT_S - 0.12, UPPERCUT_S, UPPERCUT_S + 0.3)
    left = arm(times, GUARD, (jab + last_jab, STRAIGHT), (hook, HOOK), (0.5 * cross, LOADED))
    right = arm(
        times,
        GUARD,
        (cross + last_cross, STRAIGHT),
        (load, LOADED),
        (uppercut, UPPERCUT),
        (0.3 * jab, LOADED),
    )
    for channels in (left, right):
        for name, values in channels.items():
            channels[name] = sprung(values, times, 6.5, 0.75) + 2.5 * hops * (name == "flexion")
    pelvis = {
        "x": driven(
            {0.2: 0.0, HOOK_S: 0.05, SLIP_S: -0.16, UPPERCUT_S: -0.07, 2.7: 0.05, 3.5: 0.02}, times, 3.2
        ),
        "y": driven(
            {
                0.1: 0.06,
                JAB_S: -0.10,
                CROSS_S: -0.16,
                HOOK_S: -0.12,
                SLIP_S: -0.04,
                UPPERCUT_S: -0.12,
                2.6: 0.0,
                LAST_JAB_S: -0.16,
                LAST_CROSS_S: -0.22,
                3.6: -0.1,
            },
            times,
            3.5,
        ),
        "z": tall_m(body) - 0.085 + 0.014 * hops - sprung(0.17 * slip + 0.08 * load, times, 5.0, 0.7),
        "yaw": -34.0
        + sprung(
            27 * cross + 27 * last_cross - 8 * jab - 42 * hook + 30 * uppercut - 16 * load, times, 6.0, 0.6
        ),
        "pitch": 3.0 + sprung(14 * slip + 5 * load, times, 5.0, 0.7) + 1.2 * hops,
        "roll": sprung(-9 * slip + 4 * hook, times, 5.0, 0.7),
    }
    trunk = {
        "pitch": 11.0 + sprung(17 * slip + 8 * load - 10 * uppercut, times, 5.0, 0.6),
        "roll": sprung(-16 * slip - 10 * load + 8 * uppercut - 6 * hook, times, 5.0, 0.6),
        "yaw": sprung(
            21 * cross + 21 * last_cross - 22 * jab - 22 * last_jab - 30 * hook + 18 * uppercut - 26 * load,
            times,
            6.5,
            0.58,
        ),
        "neck_yaw": 28.0
        + sprung(-40 * cross - 40 * last_cross + 24 * jab + 48 * hook - 36 * uppercut, times, 6.0, 0.7),
        "neck_pitch": 8.0 - sprung(14 * slip, times, 5.0, 0.7),
    }
    return choreography(times, random, pelvis, trunk, {"L": left, "R": right}, _feet(times, random))


def _punch(times: Array, at: float) -> Array:
    """A punch: out in a sixth of a second, back in a quarter."""
    return burst(times, at - 0.16, at, at + 0.24)


def _feet(times: Array, random: np.random.Generator) -> dict[str, tuple[Array, Array]]:
    steps = {
        "L": [(JAB_S - 0.2, JAB_S, (0.14, -0.36)), (1.42, 1.60, (0.10, -0.26)),
              (2.42, 2.60, (0.15, -0.22)), (LAST_JAB_S - 0.18, LAST_JAB_S, (0.13, -0.42))],
        "R": [(JAB_S + 0.02, JAB_S + 0.18, (-0.14, 0.08)), (1.50, 1.68, (-0.22, 0.12)),
              (2.50, 2.70, (-0.13, 0.20)), (LAST_JAB_S + 0.02, LAST_JAB_S + 0.17, (-0.12, 0.04))],
    }  # fmt: skip
    cross = burst(times, CROSS_S - 0.15, CROSS_S, CROSS_S + 0.3)
    cross = cross + burst(times, LAST_CROSS_S - 0.15, LAST_CROSS_S, LAST_CROSS_S + 0.3)
    hook = burst(times, HOOK_S - 0.2, HOOK_S, HOOK_S + 0.3)
    feet = {}
    for side, start, yaw, turn in (
        ("L", (0.13, -0.18), -12.0, -44 * hook),
        ("R", (-0.13, 0.24), -56.0, 38 * cross),
    ):
        places, lifted = stepped(times, start, steps[side])
        slide = 0.008 * np.stack([sway(FPS * times, random, (8.0, 20.0)) for _ in "xy"], axis=-1)
        heel = 20.0 if side == "R" else 5.0
        pitch = heel + 0.45 * np.abs(turn) + 12.0 * lifted
        feet[side] = foot(places + slide, yaw + sprung(turn, times, 6.0, 0.7), pitch, 0.03 * lifted)
    return feet
