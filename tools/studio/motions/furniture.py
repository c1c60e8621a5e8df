"""Stepping behind a table and telling a story: arms flung from gesture to gesture, knee bends unseen."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import burst, driven, keyed, shock, sprung, sway
from ..performance import FPS, Choreography
from ..standing import ARM, Pose, arm, choreography, foot, stepped, tall_m

BEATS_S = (0.0, 0.44, 0.80, 1.22, 1.55, 1.98, 2.36, 2.84)
"""When a gesture is reached."""
LONGEST_GLIDE_S = 0.27
LOW: Pose = {"elevation": 24, "forward": 48, "rotation": 18, "flexion": 86, "pronation": 10, "girdle": 2}
WIDE: Pose = {"elevation": 86, "forward": 22, "rotation": -6, "flexion": 30, "pronation": -30, "girdle": 10}
UP: Pose = {"elevation": 138, "forward": 34, "rotation": -14, "flexion": 40, "pronation": 0, "girdle": 22}
POINT: Pose = {"elevation": 82, "forward": 84, "rotation": 40, "flexion": 12, "pronation": 50, "girdle": 10}
HEAD: Pose = {"elevation": 100, "forward": 30, "rotation": -30, "flexion": 112, "pronation": 0, "girdle": 14}
ACROSS: Pose = {"elevation": 62, "forward": 92, "rotation": 62, "flexion": 74, "pronation": 20, "girdle": 6}
CHOP: Pose = {"elevation": 46, "forward": 82, "rotation": 16, "flexion": 52, "pronation": -10, "girdle": 0}
GESTURES: dict[str, tuple[Pose, ...]] = {
    "L": (LOW, WIDE, POINT, CHOP, UP, LOW, HEAD, WIDE),
    "R": (LOW, HEAD, LOW, ACROSS, UP, POINT, WIDE, CHOP),
}


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion."""
    beats = np.array(BEATS_S) + 0.02 * random.standard_normal(len(BEATS_S))
    travel = driven(
        {0.0: -0.95, 0.2: -0.90, 0.55: -0.56, 0.95: -0.12, 1.35: 0.0, 1.75: 0.26, 2.2: 0.22, 2.7: 0.0,
         3.0: -0.05},
        times, 3.0, 0.9)  # fmt: skip
    bends = ((1.06, 0.08), (1.46, 0.17), (2.4, 0.13))
    dips = sum(size * burst(times, at - 0.26, at, at + 0.3) for at, size in bends)
    ring = shock(times, list(beats[1:]), 5.0, 0.08)
    shake = 2.0 * np.pi * times / 0.37
    pelvis = {
        "x": travel,
        "y": 0.02 + driven({0.0: 0.04, 0.7: -0.03, 1.4: 0.06, 2.0: -0.05, 2.8: 0.02}, times, 3.0),
        "z": tall_m(body) - 0.05 - sprung(dips, times, 4.0, 0.7) - 0.008 * np.sin(shake),
        "yaw": driven(
            {0.0: 24, 0.5: 14, 0.9: -26, 1.3: -30, 1.7: 12, 2.1: 32, 2.6: -8, 3.0: -14}, times, 4.0
        ),
        "pitch": 3.0 + 60.0 * sprung(dips, times, 4.5, 0.6) + 1.5 * ring,
        "roll": driven({0.0: 4, 0.6: -6, 1.2: 5, 1.8: -5, 2.4: 6, 3.0: 0}, times),
    }
    trunk = {
        "pitch": 4.0
        + 70.0 * sprung(dips, times, 5.0, 0.55)
        - 10.0 * burst(times, 1.3, 1.6, 1.9)
        + 2.5 * ring,
        "roll": driven({0.0: -4, 0.5: 9, 0.9: -10, 1.4: 6, 1.9: -8, 2.4: 8, 3.0: -4}, times, 5.0, 0.6),
        "yaw": driven(
            {0.0: -8, 0.42: 24, 0.8: -22, 1.2: 18, 1.6: -12, 2.0: -28, 2.4: 20, 2.9: -6}, times, 5.0, 0.6
        ),
        "neck_yaw": driven(
            {0.0: -20, 0.5: 18, 0.85: 44, 1.3: 10, 1.7: -30, 2.2: -36, 2.6: 20}, times, 5.0, 0.7
        ),
        "neck_pitch": -4.0
        + 6.0 * np.sin(shake) * keyed({1.9: 0, 2.1: 1, 2.5: 1, 2.7: 0}, times)
        - 8.0 * ring,
        "neck_roll": driven({0.4: 0, 0.8: 8, 1.4: -9, 2.0: 5, 2.6: -4}, times),
    }
    arms = {side: _gestures(times, beats, GESTURES[side], late) for side, late in (("L", 0.0), ("R", 0.05))}
    chop = np.sin(2.0 * np.pi * times / 0.28) * keyed({1.05: 0, 1.2: 1, 1.4: 1, 1.5: 0}, times)
    arms["L"]["flexion"] = arms["L"]["flexion"] + 16.0 * chop
    return choreography(times, random, pelvis, trunk, arms, _feet(times, random))


def _gestures(times: Array, beats: Array, poses: tuple[Pose, ...], late_s: float) -> dict[str, Array]:
    """An arm that is flung from pose to pose, each held until shortly before the next beat."""
    amounts = []
    for number in range(len(poses)):
        own = {}
        for other, at in enumerate(beats + late_s):
            if other:
                glide = min(LONGEST_GLIDE_S, 0.8 * float(beats[other] - beats[other - 1]))
                own[float(at) - glide] = float(other - 1 == number)
            own[float(at)] = float(other == number)
        amounts.append(sprung(keyed(own, times), times, 5.0, 0.58))
    channels = {name: np.zeros(len(times)) for name in ARM}
    for amount, pose in zip(amounts, poses, strict=True):
        for name in ARM:
            channels[name] += amount * pose.get(name, 0.0)
    return {**arm(times, {}), **{name: channels[name] for name in ARM if name != "rotation"},
            "twist": channels["rotation"] - channels["forward"]}  # fmt: skip


def _feet(times: Array, random: np.random.Generator) -> dict[str, tuple[Array, Array]]:
    """Steps to the side and back."""
    steps = {
        "L": [(0.16, 0.40, (-0.40, -0.04)), (0.64, 0.86, (0.10, -0.06)), (1.44, 1.66, (0.44, -0.02)),
              (2.46, 2.66, (0.12, 0.04))],
        "R": [(0.40, 0.64, (-0.66, 0.06)), (0.88, 1.10, (-0.20, 0.10)), (1.70, 1.90, (0.08, 0.08)),
              (2.20, 2.42, (-0.20, -0.06))],
    }  # fmt: skip
    feet = {}
    for side, start, yaw in (("L", (-0.80, 0.02), 20.0), ("R", (-1.10, 0.0), -14.0)):
        places, lifted = stepped(times, start, steps[side])
        heel = 7.0 * sway(FPS * times, random, (14.0, 34.0)).clip(0.0)
        turn = driven({0.0: 10, 0.9: -8, 1.7: 12, 2.6: -6}, times, 4.0, 0.8)
        feet[side] = foot(places, yaw + turn, heel + 16.0 * lifted, 0.035 * lifted)
    return feet
