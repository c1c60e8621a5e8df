"""The demonstration: four seconds of aerobic exercise, composed from keyed channels.

Side step left, knee lift right, side step right with both arms up, knee lift left, back to standing. The feet
are keyed in the world and the legs reach for them, so a planted foot stands exactly still. Frames count from
0 and may be fractional; angles are degrees here.
"""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from scipy.ndimage import gaussian_filter1d

from .curves import Keys, keyed, sway
from .limbs import turned
from .performance import SIDES, STEPS_PER_FRAME, Choreography, Performance, compose, stored_times

Step = tuple[float, float, tuple[float, float], float]
"""Frames of lifting and landing, landing position (x, y) [m], height of the path [m]."""

FRAME_COUNT = 118
SMOOTHING_FRAMES = 1.6
ANKLE_HEIGHT_M = 0.082
TOES_OUT_DEG = {"L": 9.0, "R": -6.0}
SWAY_M, SWAY_DEG = 0.004, 1.1

ACTOR = Actor(
    {
        "upper_arm.L": 0.292,
        "upper_arm.R": 0.292,
        "forearm.L": 0.249,
        "forearm.R": 0.249,
        "hand.L": 0.176,
        "hand.R": 0.176,
        "thigh.L": 0.418,
        "thigh.R": 0.418,
        "shin.L": 0.409,
        "shin.R": 0.409,
        "foot.L": 0.185,
        "foot.R": 0.185,
        "shoulder_width": 0.345,
        "hip_width": 0.184,
        "trunk": 0.482,
        "neck_head": 0.238,
    }
)

STEPS: dict[str, list[Step]] = {
    "L": [(2, 15, (0.50, 0.00), 0.085), (67, 80, (0.12, 0.01), 0.075), (85, 104, (0.13, -0.02), 0.37)],
    "R": [(17, 29, (0.31, 0.02), 0.070), (33, 52, (0.27, -0.01), 0.40), (54, 66, (-0.13, 0.01), 0.090)],
}
STANDING = {"L": (0.11, 0.0), "R": (-0.11, 0.01)}
KNEE_LIFT_FORWARD_M = 0.16
"""Forward offset of the lifted foot at the top of a knee lift."""
KNEE_LIFT_FROM_M = 0.2

PELVIS: dict[str, Keys] = {
    "x": {
        0: 0.0,
        5: -0.045,
        15: 0.20,
        20: 0.31,
        29: 0.425,
        42: 0.462,
        52: 0.41,
        57: 0.43,
        66: 0.19,
        72: 0.02,
        80: -0.045,
        94: -0.095,
        105: -0.02,
        117: 0.0,
    },
    "y": {0: 0.02, 15: 0.035, 29: 0.025, 42: 0.045, 52: 0.02, 66: 0.045, 80: 0.02, 94: 0.04, 117: 0.02},
    "z": {
        0: 0.895,
        8: 0.885,
        15: 0.845,
        20: 0.850,
        29: 0.880,
        35: 0.868,
        42: 0.890,
        52: 0.868,
        57: 0.875,
        66: 0.838,
        72: 0.852,
        80: 0.878,
        87: 0.866,
        94: 0.890,
        105: 0.868,
        111: 0.882,
        117: 0.894,
    },
    "yaw": {0: 0, 15: 5, 29: 1, 42: 9, 54: 2, 66: -6, 80: -1, 94: -9, 106: -2, 117: 0},
    "pitch": {0: 2, 15: 6, 29: 3, 42: -5, 54: 4, 66: 7, 80: 4, 94: -5, 106: 4, 117: 2},
    "roll": {0: 0, 5: -2, 15: 1, 29: 1, 42: 5, 54: 1, 66: -1, 80: -1, 94: -5, 106: -1, 117: 0},
}
"""Hips' midpoint [m]; yaw turns left, pitch bows, roll raises the right side."""

TRUNK: dict[str, Keys] = {
    "pitch": {0: 1, 15: 4, 29: 5, 42: 10, 54: 3, 66: -3, 80: 9, 94: 11, 106: 4, 117: 1},
    "roll": {0: 0, 6: 2, 15: -2, 29: 1, 42: -7, 54: 0, 66: 3, 80: 1, 94: 8, 106: 1, 117: 0},
    "yaw": {0: 0, 15: 2, 29: 4, 42: -16, 54: -2, 66: 3, 80: 0, 94: 15, 106: 2, 117: 0},
    "neck_pitch": {0: 0, 15: -4, 29: 3, 42: 4, 54: -3, 66: -9, 80: -4, 94: 2, 117: 0},
    "neck_yaw": {0: 0, 12: 14, 29: 5, 42: 8, 60: -16, 70: -10, 80: 0, 94: -9, 117: 1},
    "neck_roll": {0: 1, 15: 2, 42: 4, 66: -2, 94: -5, 117: 0},
}

ARMS: dict[str, dict[str, Keys]] = {
    "L": {
        "elevation": {0: 13, 3: 15, 15: 91, 18: 88, 29: 48, 42: 96, 52: 52, 66: 156, 69: 152, 80: 84,
                      94: 62, 106: 30, 117: 14},
        "forward": {0: 18, 15: 9, 29: 62, 42: 64, 52: 34, 66: 14, 80: 76, 94: -14, 106: 24, 117: 20},
        "twist": {0: -6, 15: -8, 29: 10, 42: 20, 66: -10, 80: 12, 94: -22, 117: -6},
        "flexion": {0: 17, 8: 34, 15: 13, 29: 96, 42: 38, 52: 78, 58: 70, 66: 21, 72: 58, 80: 24, 94: 82,
                    106: 52, 117: 20},
        "pronation": {0: 20, 15: 35, 29: 10, 42: 25, 66: -10, 80: 40, 94: 15, 117: 20},
        "girdle": {0: 0, 15: 7, 29: 2, 42: 9, 52: 2, 66: 25, 80: 8, 94: 4, 117: 0},
    },
    "R": {
        "elevation": {0: 11, 4: 14, 16: 84, 19: 82, 30: 44, 43: 66, 53: 50, 67: 163, 70: 158, 81: 88, 95: 101,
                      106: 34, 117: 12},
        "forward": {0: 14, 16: 4, 30: 66, 43: -18, 53: 30, 67: 8, 81: 80, 95: 58, 106: 28, 117: 16},
        "twist": {0: -4, 16: -5, 30: 8, 43: -24, 67: -14, 81: 9, 95: 22, 117: -5},
        "flexion": {0: 14, 9: 40, 16: 17, 30: 104, 43: 76, 53: 70, 59: 74, 67: 16, 73: 62, 81: 18, 95: 42,
                    106: 60, 117: 17},
        "pronation": {0: 15, 16: 30, 30: 15, 43: 20, 67: -5, 81: 35, 95: 30, 117: 15},
        "girdle": {0: 0, 16: 5, 30: 2, 43: 4, 53: 2, 67: 27, 81: 9, 95: 10, 117: 0},
    },
}  # fmt: skip


def perform(seed: int) -> Performance:
    """Compose the performance; `seed` determines its small natural sway."""
    times = stored_times(FRAME_COUNT)
    random = np.random.default_rng(seed)
    pelvis = {name: _curve(keys, times) for name, keys in PELVIS.items()}
    for name, values in pelvis.items():
        values += sway(times, random) * (SWAY_M if name in "xyz" else SWAY_DEG)
    trunk = {n: _curve(keys, times) + SWAY_DEG * sway(times, random) for n, keys in TRUNK.items()}
    arms = {
        side: {n: _curve(keys, times) + 2.0 * SWAY_DEG * sway(times, random) for n, keys in channels.items()}
        for side, channels in ARMS.items()
    }
    feet = {side: _foot(side, times) for side in SIDES}
    return compose(Body(ACTOR), times, Choreography(pelvis, trunk, arms, feet, exact_reach=True))


def _curve(keys: Keys, times: Array) -> Array:
    """A smooth curve through keys that does not overshoot them."""
    values = keyed(keys, np.clip(times, 0.0, FRAME_COUNT - 1.0))
    return np.asarray(gaussian_filter1d(values, SMOOTHING_FRAMES * STEPS_PER_FRAME, mode="nearest"))


def _foot(side: str, times: Array) -> tuple[Array, Array]:
    """An ankle's path (T, 3) [m] and the foot's world rotation (T, 3, 3)."""
    ankle = np.empty((len(times), 3))
    pitch = np.zeros(len(times))
    here = np.array(STANDING[side])
    ankle[:] = *here, ANKLE_HEIGHT_M
    for lifts, lands, target, rise in STEPS[side]:
        share = np.clip((times - lifts) / (lands - lifts), 0.0, 1.0)
        there = np.array(target)
        eased = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
        bump = np.sin(np.pi * share) ** 2
        moving = share > 0.0
        path = here + eased[:, None] * (there - here)
        ankle[moving, :2] = path[moving]
        ankle[moving, 2] = ANKLE_HEIGHT_M + rise * bump[moving]
        if rise > KNEE_LIFT_FROM_M:
            ankle[moving, 1] -= KNEE_LIFT_FORWARD_M * bump[moving]
        pitch[moving] = (18.0 + 45.0 * rise) * bump[moving]
        here = there
    outward = np.full(len(times), TOES_OUT_DEG[side])
    return ankle, turned(outward, pitch, np.zeros(len(times)))
