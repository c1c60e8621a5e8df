"""Hands that hang relaxed: a little bent toward the palm, and drooping where the forearm is level."""

import numpy as np

from ..arrays import Array
from ..body.kinematics import Body, Pose
from ..body.rotations import cross, exponential
from ..body.skeleton import SIDES

CURL_RAD = np.radians(12.0)
"""Bend of a relaxed hand toward the palm, half-closed fingers included, which one bone stands for."""
DROOP_RAD = np.radians(12.0)
"""What its weight bends a hand by when the forearm is level."""
DOWN = np.array([0.0, 0.0, -1.0])


def hand_turns(body: Body, pose: Pose) -> dict[str, Array]:
    """(F, 3, 3) turn of each hand in its forearm's frame, by name of segment.

    At rest palms face down: a hand bends toward its palm about Y, the left one positively.
    """
    turns = {}
    for side in SIDES:
        name = f"hand.{side}"
        hand = next(segment for segment in body.skeleton.segments if segment.name == name)
        along = body.local(hand.end) - body.local(hand.start)
        fingers = along / np.linalg.norm(along)
        toward_palm = np.cross(fingers, DOWN)
        down = np.swapaxes(pose.rotation[..., hand.joint, :, :], -1, -2) @ DOWN
        droop = DROOP_RAD * cross(np.broadcast_to(fingers, down.shape), down)
        turns[name] = exponential(CURL_RAD * toward_palm + droop)
    return turns
