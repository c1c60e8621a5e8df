"""Feet of the mannequin, turned at the ankle where the skeleton's rigid feet would go below the floor."""

import numpy as np

from ..arrays import Array
from ..body import rotations
from ..body.kinematics import Body, Pose
from ..body.skeleton import SIDES
from ..body.soles import sole_places

UP = np.array([0.0, 0.0, 1.0])


def foot_frame_index(body: Body, segment: str) -> int:
    """Index of a foot's frame among the frames of the skin, after those of the joints."""
    return len(body.skeleton.joints) + SIDES.index(segment.rsplit(".", 1)[-1])


def skin_frames(body: Body, pose: Pose) -> tuple[Array, Array]:
    """The frames that move the skin of a single posture.

    Returns:
        (J + 2, 3, 3) and (J + 2, 3): rotations and origins [m] of the joints, then of the left and the right
        foot, which is the shin's unless heel or tip would be below the floor z = 0.
    """
    turned, origins = [pose.rotation], [pose.origin]
    for side, sole in zip(SIDES, sole_places(body, pose), strict=True):
        foot = next(segment for segment in body.skeleton.segments if segment.name == f"foot.{side}")
        ankle = pose.place(foot.joint, body.local(foot.start))
        turn = _floor_correction(sole[0] - ankle, sole[1] - ankle, float(ankle[2]))
        turned.append((turn @ pose.rotation[foot.joint])[None])
        origins.append((ankle + turn @ (pose.origin[foot.joint] - ankle))[None])
    return np.concatenate(turned), np.concatenate(origins)


def _floor_correction(heel: Array, tip: Array, height_m: float) -> Array:
    """(3, 3) smallest rotation about the ankle that brings the sole to the floor, at most to a level foot.

    Args:
        heel: The heel, from the ankle [m].
        tip: The foot's tip, from the ankle [m].
        height_m: Height of the ankle.
    """
    along = tip - heel
    ahead = along * [1.0, 1.0, 0.0]
    low, length = min(heel[2], tip[2]), float(np.linalg.norm(ahead))
    if height_m + low >= 0.0 or length < 1e-6:
        return np.eye(3)
    ahead /= length
    toes = low == tip[2]
    end = tip if toes else heel
    # Angles of the end above the foot's direction, in the foot's plane: the wanted one and the present one.
    lift = np.arcsin(np.clip(-height_m / np.linalg.norm(end), -1.0, 1.0))
    sign = 1.0 if toes else -1.0
    present = np.arctan2(end[2], sign * float(end @ ahead))
    level = abs(np.arctan2(along[2], length))
    angle = sign * min(lift - present, level)
    return rotations.exponential(angle * np.cross(ahead, UP))
