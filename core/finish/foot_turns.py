"""Feet that lie flat while they rest, roll over heel and toes, and never pass the ground.

The skeleton's feet are rigid with the shins. Here each is turned about its ankle: it follows the shin as far
as the ground and the ankle's range let it, so that it comes down on its heel, lies flat, rolls over its tip
as the heel rises, and hangs once it is high. Heading comes from the shin, but for a resting foot's, which
stays.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from ..arrays import Array
from ..body.kinematics import Body, Pose
from ..body.rotations import hinge
from ..body.skeleton import SIDES
from .contacts import Contact
from .foot_ground import FootGround, find_ground, smooth_step
from .foot_pitch import TOES_DOWN_RAD, TOES_UP_RAD, Soles

HANGING_RAD = np.radians(20.0)
"""Plantarflexion of a foot that hangs free, well above the ground; near it the toes are kept up."""
HANGING_FROM_M, HANGING_AT_M = 0.15, 0.5
"""Heights of the sole above the ground between which a foot begins to hang."""
SWING_CLEARANCE_M = 0.013
"""Least clearance of the toes in the swing of a step (Winter 1992, *Physical Therapy* 72)."""
STANDS_M_S, SWINGS_M_S = 1.0, 2.5
"""Speeds of the ankle below which no clearance is kept, and above which all of it."""
STILL_M_S, LOW_M = 0.2, 0.04
"""Speed and height above a flat foot's at which a foot that does not rest counts as standing by half: it
sways, or slides."""
SOLE_OUT_RAD, SOLE_IN_RAD = np.radians(20.0), np.radians(35.0)
"""Eversion and inversion (AAOS 1965)."""
LEVEL_WITHIN_M = 0.1
"""Height above a flat foot's at which its sole is no longer held level across."""
UPRIGHT_RAD = np.radians(35.0), np.radians(60.0)
"""Leans of a shin to its side from which on, and at which, the ground no longer turns its foot."""
FREE_HEADING_RAD = np.radians(15.0)
"""A resting foot keeps its heading while the shin turns by no more than this above it."""
SMOOTHING_S = 0.03
FASTEST_RAD_S = np.radians(700.0)
"""Angular speed of an ankle: that of a sprinter's push-off."""


@dataclass(frozen=True, eq=False)
class _Shins:
    """Orientation of both shins as Rz(heading) Ry(roll) Rx(pitch), each (F, 2), and their ankles."""

    rotation: Array
    """(F, 2, 3, 3)."""
    heading: Array
    roll: Array
    pitch: Array
    ankle: Array
    """(F, 2, 3) [m]."""


def foot_turns(body: Body, pose: Pose, time_s: Array, contacts: Sequence[Contact]) -> dict[str, Array]:
    """(F, 3, 3) turn of each foot in its shin's frame, by name of segment.

    Args:
        body: The body.
        pose: Its poses in F frames.
        time_s: (F,) time of each frame [s].
        contacts: Rests of the ankles, 0 the left and 1 the right.
    """
    shins, soles = _shins(body, pose), Soles.of(body)
    upright = 1.0 - smooth_step((np.abs(shins.roll) - UPRIGHT_RAD[0]) / (UPRIGHT_RAD[1] - UPRIGHT_RAD[0]))
    ground = find_ground(shins.ankle, soles.clearance_m(shins.pitch), time_s, contacts)
    height = shins.ankle[..., 2] - ground.height_m
    flat = soles.depth_m(np.zeros(2), np.ones(2))
    speed = _speed(shins.ankle, time_s)
    standing = ground.resting + (1.0 - ground.resting) * _still(speed, height - flat)
    # Across, the sole is level where it is near the ground, as far as the joint lets it.
    near = np.maximum(ground.resting, 1.0 - smooth_step((height - flat) / LEVEL_WITHIN_M)) * upright
    leveling = -near * _within_range(shins.roll)
    level = np.cos(shins.roll + leveling)
    free = shins.pitch + HANGING_RAD * smooth_step(
        (height - flat - HANGING_FROM_M) / (HANGING_AT_M - HANGING_FROM_M)
    )
    free += ground.on_toes * np.maximum(soles.on_tiptoe(height) - free, 0.0)
    low, high = shins.pitch - TOES_UP_RAD, shins.pitch + TOES_DOWN_RAD
    lifted = height - SWING_CLEARANCE_M * smooth_step((speed - STANDS_M_S) / (SWINGS_M_S - STANDS_M_S))
    wanted = soles.above_ground(np.clip(free, low, high), np.maximum(lifted, 0.0), level, shins.pitch)
    wanted += standing * upright * (np.clip(0.0, low, high) - wanted)
    turned = _held_heading(shins, contacts, ground) * upright
    bent = _smoothed(np.stack([wanted - shins.pitch, leveling, turned]), time_s)
    pitch = soles.above_ground(shins.pitch + bent[0], height, np.cos(shins.roll + bent[1]), shins.pitch)
    turns = _turns(shins, pitch, bent[1], bent[2])
    return {f"foot.{side}": turns[:, number] for number, side in enumerate(SIDES)}


def _shins(body: Body, pose: Pose) -> _Shins:
    feet = [next(s for s in body.skeleton.segments if s.name == f"foot.{side}") for side in SIDES]
    rotation = np.stack([pose.rotation[:, foot.joint] for foot in feet], axis=1)
    return _Shins(
        rotation,
        np.arctan2(rotation[..., 1, 0], rotation[..., 0, 0]),
        -np.arcsin(np.clip(rotation[..., 2, 0], -1.0, 1.0)),
        np.arctan2(rotation[..., 2, 1], rotation[..., 2, 2]),
        np.stack([pose.place(foot.joint, body.local(foot.start)) for foot in feet], axis=1),
    )


def _speed(places: Array, time_s: Array) -> Array:
    """(F, 2) speed of both ankles [m/s]."""
    if len(time_s) < 2:
        return np.zeros(places.shape[:2])
    return np.asarray(np.linalg.norm(np.gradient(places, time_s, axis=0), axis=-1))


def _still(speed: Array, above: Array) -> Array:
    """(F, 2) how far feet stand by their speed and their height above flat feet's, 0 to 1."""
    return np.asarray(1.0 / (1.0 + (speed / STILL_M_S) ** 4) / (1.0 + (above / LOW_M) ** 4))


def _within_range(roll: Array) -> Array:
    """(F, 2) rolls by which the joints can counter those of the shins."""
    # A positive roll lowers the left foot's outer edge; countering it turns the sole outwards.
    out = np.array([1.0, -1.0])
    return np.asarray(out * np.clip(out * roll, -SOLE_IN_RAD, SOLE_OUT_RAD))


def _held_heading(shins: _Shins, contacts: Sequence[Contact], ground: FootGround) -> Array:
    """(F, 2) turns about the vertical that keep resting feet's headings."""
    turned = np.zeros_like(shins.heading)
    for contact in contacts:
        rows, foot = slice(contact.first, contact.last + 1), contact.point
        heading = np.unwrap(shins.heading[rows, foot])
        middle = 0.5 * (heading.min() + heading.max())
        weight = np.maximum(ground.resting, ground.on_toes)[rows, foot]
        turned[rows, foot] = weight * np.clip(middle - heading, -FREE_HEADING_RAD, FREE_HEADING_RAD)
    return turned


def _smoothed(angles: Array, time_s: Array) -> Array:
    """Angles (..., F, 2) without what a joint cannot do: leaps, and a tremor from frame to frame."""
    if len(time_s) < 2:
        return angles
    frame_s = max(float(np.median(np.diff(time_s))), 1e-6)
    slower = _limited(angles, time_s)
    return np.asarray(gaussian_filter1d(slower, SMOOTHING_S / frame_s, axis=-2, mode="nearest", truncate=3.0))


def _limited(angles: Array, time_s: Array) -> Array:
    """Angles (..., F, 2) whose speed is within that of a joint; those that are anyway stay as they are.

    The mean of the lowest curve above and the highest below that are slow enough.
    """
    above, below = angles.copy(), angles.copy()
    step = FASTEST_RAD_S * np.diff(time_s)
    for frame in range(1, len(time_s)):
        above[..., frame, :] = np.maximum(above[..., frame, :], above[..., frame - 1, :] - step[frame - 1])
        below[..., frame, :] = np.minimum(below[..., frame, :], below[..., frame - 1, :] + step[frame - 1])
    for frame in range(len(time_s) - 2, -1, -1):
        above[..., frame, :] = np.maximum(above[..., frame, :], above[..., frame + 1, :] - step[frame])
        below[..., frame, :] = np.minimum(below[..., frame, :], below[..., frame + 1, :] + step[frame])
    return np.asarray(0.5 * (above + below))


def _turns(shins: _Shins, pitch: Array, leveling: Array, turned: Array) -> Array:
    """(F, 2, 3, 3) the feet's turns in the shins' frames."""
    x, y, z = np.eye(3)
    # The shin's own pitch and roll are undone before the foot's are done: where the shin lies on its side and
    # its pitch means nothing, only the difference counts.
    undone = hinge(x, -shins.pitch) @ hinge(y, -shins.roll) @ hinge(z, turned)
    return np.asarray(undone @ hinge(y, shins.roll + leveling) @ hinge(x, pitch))
