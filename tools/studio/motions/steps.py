"""Climbing three steps briskly: each foot is set two steps farther on, the trailing knee swings through."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, keyed, shock, sprung
from ..limbs import foot_clearance, turned
from ..performance import Choreography
from ..standing import arm, choreography, tall_m

RISE_M, TREAD_M, FIRST_M = 0.17, 0.30, -0.25
"""Height and depth of a step; where its first edge is, along -Y."""
ASIDE_M = 0.075
PACE_S = 0.52
"""From landing to landing."""
Set = tuple[float, float, float, float]
"""Times of lifting and landing, place of the ankle along -Y and height of the floor there [m]."""
SWINGING = {"elevation": 4, "forward": 92, "rotation": 0, "flexion": 44, "pronation": 15, "girdle": 2}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion, along -Y."""
    sets = _sets()
    landings = sorted(step[1] for side in sets.values() for step in side[1:])
    ring = shock(times, landings, 6.0, 0.08)
    push = sum(burst(times, at - 0.02, at + 0.22, at + 0.48) for at in landings[:4])
    ends = [(-0.3, -0.76, 0.0), *_middles(sets)]
    along = driven({at: y for at, y, _ in ends}, times, 3.2, 0.95)
    height = driven({at: z for at, _, z in ends}, times, 3.4, 0.9)
    turn = np.pi * keyed({at: number for number, at in enumerate([-0.3, *landings, 4.0])}, times)
    calm = keyed({landings[-1] - 0.1: 1, landings[-1] + 0.3: 0.1}, times)
    pelvis = {
        "x": -0.020 * calm * np.cos(turn),
        "y": -along,
        "z": tall_m(body) - 0.06 + height + 0.022 * push - 0.006 * ring,
        "yaw": 7.0 * calm * np.cos(turn + 0.3),
        "pitch": 6.0 + 9.0 * sprung(push, times, 5.0, 0.7) * calm,
        "roll": 5.0 * calm * np.sin(turn + 0.3),
    }
    trunk = {
        "pitch": 6.0 + 7.0 * sprung(push, times, 4.0, 0.7) * calm - ring,
        "roll": -5.0 * calm * np.sin(turn + 0.3),
        "yaw": -14.0 * calm * np.cos(turn + 0.3),
        "neck_pitch": driven({0.0: 12, 1.4: 14, 2.2: 2, 2.9: -8}, times, 3.0),
        "neck_yaw": driven({0.0: 0, 1.6: -6, 2.4: 30, 3.0: 42}, times, 3.5),
    }
    arms = {}
    for side, sign in (("L", -1.0), ("R", 1.0)):
        swing = sprung(sign * calm * np.cos(turn), times, 4.5, 0.65)
        arms[side] = arm(
            times, SWINGING, (swing, {"elevation": 40, "forward": 76, "flexion": 70, "rotation": 8})
        )
    feet = {}
    for side, out in (("L", 1.0), ("R", -1.0)):
        feet[side] = _foot(times, sets[side], out)
    return choreography(times, random, pelvis, trunk, arms, feet)


def boxes() -> list[tuple[float, float, float]]:
    """Length, middle along Y and height of the middle of the boxes that are the steps [m]."""
    far = FIRST_M + 3.0 * TREAD_M + 0.55
    found = []
    for number in range(3):
        edge = FIRST_M + TREAD_M * number
        found.append((far - edge, -0.5 * (far + edge), RISE_M * (number + 0.5)))
    return found


def _sets() -> dict[str, list[Set]]:
    """Where and when feet are set: one on the floor, one on each step, both on the last."""
    treads = [FIRST_M + TREAD_M * (number + 0.34) for number in range(3)]
    places = [
        ("L", FIRST_M - 0.22, 0.0),
        ("R", treads[0], RISE_M),
        ("L", treads[1], 2.0 * RISE_M),
        ("R", treads[2], 3.0 * RISE_M),
        ("L", treads[2] + 0.30, 3.0 * RISE_M),
        ("R", treads[2] + 0.27, 3.0 * RISE_M),
    ]
    sets: dict[str, list[Set]] = {"L": [(-9.0, -8.0, -0.86, 0.0)], "R": [(-9.0, -8.0, -0.62, 0.0)]}
    for number, (side, place, floor) in enumerate(places):
        lands = 0.24 + PACE_S * number
        sets[side].append((lands - 0.78 * PACE_S, lands, place, floor))
    return sets


def _middles(sets: dict[str, list[Set]]) -> list[tuple[float, float, float]]:
    """Time, place along -Y and height of the floor under the hips [m] when a foot lands, and at the end."""
    steps = sorted((step for side in sets.values() for step in side), key=lambda step: step[1])
    found = []
    for before, step in zip(steps[1:-1], steps[2:], strict=True):
        found.append((step[1], 0.52 * before[2] + 0.48 * step[2], before[3] + 0.08 * (step[3] - before[3])))
    last = steps[-1]
    return [*found, (last[1] + 0.35, last[2] + 0.01, last[3] + 0.015)]


def _foot(times: Array, sets: list[Set], out: float) -> tuple[Array, Array]:
    """A foot that lifts its heel, swings up and over the edge, and is set down."""
    place, floor = np.full(len(times), sets[0][2]), np.full(len(times), sets[0][3])
    lift, pitch = np.zeros(len(times)), np.full(len(times), 2.0)
    for before, (lifts, lands, target, height) in zip(sets, sets[1:], strict=False):
        share = np.clip((times - lifts) / (lands - lifts), 0.0, 1.0)
        up = np.clip(share / 0.62, 0.0, 1.0)
        over = np.clip((share - 0.10) / 0.90, 0.0, 1.0)
        place += over**2 * (3.0 - 2.0 * over) * (target - before[2])
        floor += up**2 * (3.0 - 2.0 * up) * (height - before[3])
        lift += 0.055 * np.sin(np.pi * share) ** 1.5
        pitch += 44.0 * burst(times, lifts - 0.18, lifts + 0.04, lands - 0.10) * (lifts > -1.0)
    rotation = turned(np.full(len(times), 7.0 * out), pitch, np.zeros(len(times)))
    ankle = np.stack(
        [np.full(len(times), out * ASIDE_M), -place, foot_clearance(rotation) + floor + lift], axis=-1
    )
    return ankle, rotation
