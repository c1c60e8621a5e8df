"""Building blocks of motions: a standing person, poses to mix, and feet that step.

Times are seconds; angles are degrees.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body

from .curves import sway
from .limbs import FreeLeg, foot_clearance, turned
from .performance import FPS, SIDES, Channels, Choreography

Pose = Mapping[str, float]
Mix = Sequence[tuple[Array, Pose]]

PELVIS = ("x", "y", "z", "yaw", "pitch", "roll")
TRUNK = ("pitch", "roll", "yaw", "neck_pitch", "neck_roll", "neck_yaw")
ARM = ("elevation", "forward", "rotation", "flexion", "pronation", "girdle")
LEG = ("flexion", "outward", "twist", "knee", "ankle")
HANGING: Pose = {"elevation": 9.0, "forward": 30.0, "rotation": 12.0, "flexion": 18.0, "pronation": 15.0}
ANKLE_M = 0.082
SLOW_M, SLOW_DEG = 0.004, 1.2
QUICK_FRAMES = (3.0, 9.0)
QUICK_M, QUICK_DEG = 0.0006, 0.3
"""Amplitudes of a living body's sway, slow and quick."""


def tall_m(body: Body) -> float:
    """The hips' height [m] with nearly straight legs."""
    lengths = body.actor.segments_m
    return ANKLE_M + 0.985 * (lengths["thigh.L"] + lengths["shin.L"])


def mixed(names: Sequence[str], times: Array, rest: Pose, *poses: tuple[Array, Pose]) -> Channels:
    """Channels blended from `rest` to each pose by its amount (T,); channels missing in a pose stay."""
    channels = {name: np.full(len(times), float(rest.get(name, 0.0))) for name in names}
    for amount, pose in poses:
        for name, value in pose.items():
            channels[name] += amount * (value - rest.get(name, 0.0))
    return channels


def arm(times: Array, rest: Pose, *poses: tuple[Array, Pose]) -> Channels:
    """An arm's channels; `rotation` turns the bent forearm from forward or upward to inward."""
    channels = mixed(ARM, times, rest, *poses)
    channels["twist"] = channels.pop("rotation") - channels["forward"]
    return channels


def free(times: Array, share: Array, rest: Pose, *poses: tuple[Array, Pose]) -> FreeLeg:
    """A leg that swings by its angles for a share (T,) of the time."""
    return FreeLeg(**mixed(LEG, times, rest, *poses), share=share)


def foot(
    place: Array, yaw: Array | float = 0.0, pitch: Array | float = 0.0, height: Array | float = 0.0
) -> tuple[Array, Array]:
    """An ankle's path (T, 3) and the foot's rotations (T, 3, 3).

    Args:
        place: (T, 2) position of the ankle over the floor [m].
        yaw: (T,) direction of the toes, to the left of -Y.
        pitch: (T,) toes downward.
        height: (T,) height of the lowest point of the sole [m].
    """
    zero = np.zeros(len(place))
    rotation = turned(zero + yaw, zero + pitch, zero)
    return np.column_stack([place, foot_clearance(rotation) + height]), rotation


def stepped(
    times: Array, start: tuple[float, float], steps: Sequence[tuple[float, float, tuple[float, float]]]
) -> tuple[Array, Array]:
    """A foot's positions (T, 2) [m] over steps (lifting, landing, target), and its lift (T,) from 0 to 1."""
    places = np.tile(np.array(start), (len(times), 1))
    lifted = np.zeros(len(times))
    for lifts, lands, there in steps:
        share = np.clip((times - lifts) / (lands - lifts), 0.0, 1.0)
        eased = share**2 * (3.0 - 2.0 * share)
        places += eased[:, None] * (np.array(there) - places[-1])
        lifted += np.sin(np.pi * share**0.8) ** 1.5
    return places, lifted


def choreography(
    times: Array,
    random: np.random.Generator,
    pelvis: Channels,
    trunk: Channels,
    arms: dict[str, Channels],
    feet: dict[str, tuple[Array, Array]] | None = None,
    free_legs: dict[str, FreeLeg] | None = None,
    grounded: Array | None = None,
) -> Choreography:
    """A plan with missing channels at zero and natural sway on all of them."""
    frames = FPS * times
    zero = np.zeros(len(times))

    def restless(channels: Channels, names: Sequence[str], factor: float) -> Channels:
        complete = {}
        for name in names:
            meters = name in ("x", "y", "z")
            slow = (SLOW_M if meters else SLOW_DEG) * sway(frames, random)
            quick = (QUICK_M if meters else QUICK_DEG) * sway(frames, random, QUICK_FRAMES)
            complete[name] = channels.get(name, zero) + factor * (slow + quick)
        return complete

    moved = [name if name != "rotation" else "twist" for name in ARM]
    return Choreography(
        restless(pelvis, PELVIS, 1.0),
        restless(trunk, TRUNK, 1.0),
        {side: restless(arms[side], moved, 2.0) for side in SIDES},
        feet or {},
        free_legs or {},
        grounded,
    )
