"""Joint rotations of the skeleton from the angles and positions that describe an exercise."""

from dataclasses import dataclass

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body
from keymark.core.body.rotations import exponential, hinge, logarithm

X, Y, Z = np.eye(3)
MIRROR = np.diag([-1.0, 1.0, 1.0])
"""Reflection in the sagittal plane x = 0."""
STRAIGHTEST = 0.9985
"""Largest reach as a share of a leg's length: a fully stretched leg has no knee direction."""
STRETCHING = 0.975
"""Share of its length above which a leg resists stretching."""
SOLE = np.array([[0.0, 0.065, -0.082], [0.0, -0.145, -0.082], [0.0, -0.19, -0.078]])
"""Heel, ball and tip of a foot, from its ankle [m]."""


@dataclass(frozen=True, eq=False)
class FreeLeg:
    """A leg that swings by angles instead of reaching for a position; all (T,), degrees except `share`."""

    flexion: Array
    """Flexion of the hip, forward."""
    outward: Array
    """Angle of the plane of flexion from straight ahead; at 90 flexion lifts the leg sideways."""
    twist: Array
    """Twist of the thigh, toes outward."""
    knee: Array
    """Flexion of the knee."""
    ankle: Array
    """Plantar flexion, toes downward."""
    share: Array
    """Weight of these angles against the reached position, from 0 to 1."""


def turned(yaw: Array, pitch: Array, roll: Array) -> Array:
    """Rotations (T, 3, 3) that bow by `pitch`, lean by `roll` and turn left by `yaw` (T,) [degrees]."""
    return np.asarray(hinge(Z, np.radians(yaw)) @ hinge(Y, np.radians(roll)) @ hinge(X, np.radians(pitch)))


def arm_rotations(side: str, elevation: Array, forward: Array, twist: Array) -> Array:
    """Shoulder rotations (T, 3, 3) relative to the chest.

    Args:
        side: `L` or `R`.
        elevation: (T,) angle from hanging down [degrees]; 90 is level, 180 overhead.
        forward: (T,) angle of the plane of elevation before the sideways plane [degrees].
        twist: (T,) turn about the upper arm itself [degrees].
    """
    left = (
        hinge(Z, -np.radians(forward)) @ hinge(Y, np.radians(90.0 - elevation)) @ hinge(X, np.radians(twist))
    )
    return np.asarray(left if side == "L" else MIRROR @ left @ MIRROR)


def leg_rotations(
    body: Body, side: str, pelvis: Array, pelvis_rotation: Array, ankle: Array, foot: Array
) -> tuple[Array, Array]:
    """Hip rotation (T, 3, 3) in the pelvis and knee flexion (T,) [rad] that put the ankle at its position.

    The knee points where the toes do.

    Args:
        body: The performer.
        side: `L` or `R`.
        pelvis: (T, 3) hips' midpoint [m].
        pelvis_rotation: (T, 3, 3).
        ankle: (T, 3) target of the ankle [m].
        foot: (T, 3, 3) rotation of the foot.

    Raises:
        ValueError: A target is out of reach.
    """
    lengths = body.actor.segments_m
    thigh, shin = lengths[f"thigh.{side}"], lengths[f"shin.{side}"]
    hip = pelvis + pelvis_rotation @ (0.5 * lengths["hip_width"] * (X if side == "L" else -X))
    reach = ankle - hip
    distance = np.linalg.norm(reach, axis=-1)
    if np.any(distance > STRAIGHTEST * (thigh + shin)):
        worst = int(np.argmax(distance))
        raise ValueError(
            f"leg {side} is {distance[worst] - thigh - shin:+.3f} m beyond its length at step {worst}"
        )
    down = reach / distance[:, None]
    across = np.cross(-foot[:, :, 1], down)  # toes point along the foot's -y
    across /= np.linalg.norm(across, axis=-1, keepdims=True)
    ahead = np.cross(down, across)
    at_hip = np.arccos((thigh**2 + distance**2 - shin**2) / (2.0 * thigh * distance))[:, None]
    at_knee = np.arccos((thigh**2 + shin**2 - distance**2) / (2.0 * thigh * shin))
    axis = -(down * np.cos(at_hip) + ahead * np.sin(at_hip))
    frame = np.stack([across, np.cross(axis, across), axis], axis=-1)
    return np.swapaxes(pelvis_rotation, -1, -2) @ frame, np.pi - at_knee


def free_leg(side: str, swing: FreeLeg, pelvis_rotation: Array) -> tuple[Array, Array, Array]:
    """Hip rotation (T, 3, 3), knee flexion (T,) [rad] and the foot's world rotation (T, 3, 3)."""
    outward, twist = np.radians(swing.outward), np.radians(swing.twist)
    left = hinge(Z, outward) @ hinge(X, -np.radians(swing.flexion)) @ hinge(Z, twist - outward)
    hip = left if side == "L" else MIRROR @ left @ MIRROR
    knee = np.radians(swing.knee)
    foot = pelvis_rotation @ hip @ hinge(X, knee + np.radians(swing.ankle))
    return hip, knee, foot


def within_reach(body: Body, side: str, pelvis: Array, pelvis_rotation: Array, ankle: Array) -> Array:
    """(T, 3) ankles moved toward the hip where the leg is too short: the heel leaves the floor."""
    lengths = body.actor.segments_m
    longest = lengths[f"thigh.{side}"] + lengths[f"shin.{side}"]
    hip = pelvis + pelvis_rotation @ (0.5 * lengths["hip_width"] * (X if side == "L" else -X))
    reach = ankle - hip
    share = np.linalg.norm(reach, axis=-1) / longest
    room = STRAIGHTEST - STRETCHING
    excess = np.clip(share - STRETCHING, 0.0, None)
    soft = np.where(excess > 0.0, STRETCHING + room * (1.0 - np.exp(-excess / room)), share)
    return np.asarray(hip + reach * (np.minimum(soft, 0.9999 * STRAIGHTEST) / share)[:, None])


def foot_clearance(foot: Array) -> Array:
    """(T,) height of an ankle above the lowest point of its sole [m], for foot rotations (T, 3, 3)."""
    return -np.asarray((foot[:, 2, None, :] * SOLE).sum(axis=-1).min(axis=-1))


def blended(first: Array, second: Array, share: Array) -> Array:
    """Rotations (T, 3, 3) interpolated on the shortest arc from `first` to `second`, by shares (T,)."""
    return np.asarray(first @ exponential(share[:, None] * logarithm(np.swapaxes(first, -1, -2) @ second)))
