"""Feet of the mannequin, turned at the ankle where the skeleton's rigid feet would go below the floor."""

import numpy as np

from ..arrays import Array
from ..body.extremities import Extremities, segment_turn
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..finish.foot_pitch import Shins, Soles
from ..finish.foot_turns import feet_on_floor

FLOOR_M = 0.0


def foot_frame_index(body: Body, segment: str) -> int:
    """Index of a foot's frame among the frames of the skin, after those of the joints."""
    return len(body.skeleton.joints) + SIDES.index(segment.rsplit(".", 1)[-1])


def skin_frames(body: Body, posture: Posture) -> tuple[Array, Array]:
    """The frames that move the skin of a single posture.

    Returns:
        (J + 2, 3, 3) and (J + 2, 3): rotations and origins [m] of the joints, then of the left and the right
        foot, which is the shin's unless heel or tip would be below the floor z = 0.
    """
    pose = body.pose(Posture.stack([posture]))
    feet = Extremities(feet_on_floor(Shins.of(body, pose), Soles.of(body), FLOOR_M))
    rotations, origins = [pose.rotation[0]], [pose.origin[0]]
    for side in SIDES:
        foot = next(segment for segment in body.skeleton.segments if segment.name == f"foot.{side}")
        ankle = body.local(foot.start)
        turn = segment_turn(body, pose, feet, foot.name)[0]
        rotations.append(turn[None])
        origins.append((pose.place(foot.joint, ankle)[0] - turn @ ankle)[None])
    return np.concatenate(rotations), np.concatenate(origins)
