"""Dancing: feet that slide, hips and chest against each other, arms flung to new poses on uneven beats."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from ..curves import driven, shock, sprung, uneven_phases
from ..performance import Choreography
from ..standing import ARM, Pose, arm, choreography, foot, tall_m

BEAT_S, UNEVENNESS = 0.50, 0.10
ARM_POSES: tuple[Pose, ...] = (
    {"elevation": 22, "forward": 50, "rotation": 24, "flexion": 92, "pronation": 20, "girdle": 4},
    {"elevation": 96, "forward": 8, "rotation": -8, "flexion": 78, "pronation": -30, "girdle": 14},
    {"elevation": 88, "forward": 84, "rotation": 66, "flexion": 64, "pronation": 50, "girdle": 8},
    {"elevation": 148, "forward": 30, "rotation": 6, "flexion": 34, "pronation": 10, "girdle": 24},
    {"elevation": 26, "forward": -24, "rotation": 0, "flexion": 18, "pronation": 35, "girdle": -4},
    {"elevation": 78, "forward": 40, "rotation": 52, "flexion": 118, "pronation": 0, "girdle": 16},
)
FORWARD_M, ASIDE_M = 0.16, 0.15


def plan(body: Body, times: Array, random: np.random.Generator) -> Choreography:
    """Compose the motion; the random source chooses the poses and steps on each beat."""
    phases = uneven_phases(times, BEAT_S, UNEVENNESS, random)
    first, last = int(np.floor(phases[0])) - 1, int(np.ceil(phases[-1])) + 1
    beats = {beat: float(np.interp(beat, phases, times)) for beat in range(first + 2, last - 1)}
    ring = shock(times, list(beats.values()), 5.0, 0.09)
    turn = 2.0 * np.pi * phases
    strength = sprung(_on_beats(beats, times, random.uniform(0.6, 1.3, len(beats)), 0.3), times, 3.0, 0.8)

    def thrown(size: float, hertz: float = 4.2) -> Array:
        """A new random value on each beat, reached with overshoot."""
        return sprung(
            _on_beats(beats, times, random.uniform(-size, size, len(beats)), 0.35), times, hertz, 0.55
        )

    travel = driven({0.0: 0.0, 0.9: 0.16, 1.9: -0.14, 2.7: -0.20, 3.4: 0.06, 4.1: 0.12}, times, 2.0, 0.9)
    pelvis = {
        "x": travel + 0.035 * strength * np.sin(0.5 * turn) + thrown(0.02),
        "y": thrown(0.05, 3.0),
        "z": tall_m(body) - 0.075 - 0.035 * strength * np.cos(turn + 0.5) - np.abs(thrown(0.05)),
        "yaw": thrown(30.0, 3.4) + 7.0 * np.sin(0.5 * turn + 0.6),
        "pitch": 3.0 + 5.0 * strength * np.sin(turn + 1.0),
        "roll": 8.0 * strength * np.sin(0.5 * turn + 0.3),
    }
    trunk = {
        "pitch": 6.0 + 7.0 * strength * np.cos(turn) + thrown(6.0) + 2.0 * ring,
        "roll": -11.0 * strength * np.sin(0.5 * turn + 0.1) + thrown(7.0),
        "yaw": -10.0 * np.sin(0.5 * turn + 1.4) + thrown(22.0, 4.8),
        "neck_pitch": -4.0 + 8.0 * strength * np.sin(turn + 2.0),
        "neck_roll": thrown(9.0),
        "neck_yaw": thrown(34.0),
    }
    arms = {side: _arm(times, beats, random) for side in ("L", "R")}
    feet = {}
    for side, out in (("L", 1.0), ("R", -1.0)):
        offbeat = 0.5 * (1.0 - out * np.sign(np.sin(np.pi * phases)))
        across = sprung(_on_beats(beats, times, random.uniform(0.6, 1.7, len(beats)), 0.45), times, 5.0, 0.75)
        along = sprung(_on_beats(beats, times, random.uniform(-1.0, 1.0, len(beats)), 0.45), times, 5.0, 0.75)
        place = np.stack([travel + out * ASIDE_M * across, FORWARD_M * along], axis=-1)
        heel = sprung(34.0 * offbeat * strength, times, 5.0, 0.7).clip(-4.0)
        hop = 0.05 * sprung(offbeat * (strength > 1.0), times, 4.0, 0.8).clip(0.0)
        feet[side] = foot(place, out * 12.0 + 0.6 * pelvis["yaw"] + thrown(14.0), heel, hop)
    return choreography(times, random, pelvis, trunk, arms, feet)


def _on_beats(beats: dict[int, float], times: Array, values: Array, glide: float) -> Array:
    """(T,) each beat's value, held until a transition of at most `glide` seconds before the next beat."""
    at = np.array(list(beats.values()))
    keys: dict[float, float] = {}
    for number, value in enumerate(values):
        keys[float(at[number])] = float(value)
        if number + 1 < len(at):
            keys[float(max(at[number + 1] - glide, at[number] + 0.04))] = float(value)
    return driven(keys, times, 12.0, 1.0)


def _arm(times: Array, beats: dict[int, float], random: np.random.Generator) -> dict[str, Array]:
    chosen = random.integers(0, len(ARM_POSES), len(beats))
    late = random.uniform(0.18, 0.3)
    channels = {}
    for name in ARM:
        values = np.array([ARM_POSES[pose].get(name, 0.0) for pose in chosen])
        channels[name] = sprung(_on_beats(beats, times, values, late), times, 4.2, 0.62)
    posed = arm(times, {})
    posed["twist"] = channels["rotation"] - channels["forward"]
    return {**posed, **{name: channels[name] for name in ARM if name != "rotation"}}
