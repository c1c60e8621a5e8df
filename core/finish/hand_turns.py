"""Hands that hang relaxed: a little bent toward the palm, drooping where the forearm is level.

A hand that reaches the ground bends back, so that its fingers do not pass it. At rest palms face down.
"""

import numpy as np

from ..arrays import Array
from ..body.kinematics import Body, Pose
from ..body.rotations import exponential
from ..body.skeleton import SIDES
from .joint_speed import steadied

CURL_RAD = np.radians(10.0)
"""Bend of a relaxed hand toward the palm, half-closed fingers included, which one bone stands for."""
DROOP_RAD = np.radians(8.0)
"""What its weight bends a hand by when the forearm is level."""
BACK_RAD, TO_PALM_RAD = np.radians(70.0), np.radians(80.0)
"""Extension and flexion of a wrist (AAOS 1965, *Joint Motion*)."""
THICKNESS_M = 0.012
"""Height of the fingers' middle above the ground that they lie on."""
BACK_FROM_RAD = np.radians(-15.0)
"""The hand bends back where what is straight down lies beyond this bend, or else toward the palm."""
DOWN = np.array([0.0, 0.0, -1.0])


def hand_turns(body: Body, pose: Pose, ground_m: Array, time_s: Array) -> dict[str, Array]:
    """(F, 3, 3) turn of each hand in its forearm's frame, by name of segment.

    Args:
        body: The body.
        pose: Its poses in F frames.
        ground_m: (F,) height of the ground.
        time_s: (F,) time of each frame [s].
    """
    turns = {}
    for side in SIDES:
        name = f"hand.{side}"
        hand = next(segment for segment in body.skeleton.segments if segment.name == name)
        along = body.local(hand.end) - body.local(hand.start)
        length = float(np.linalg.norm(along))
        to_palm, aside = np.cross(along / length, DOWN), DOWN
        frame = pose.rotation[:, hand.joint]
        down = np.swapaxes(frame, -1, -2) @ DOWN
        droop = DROOP_RAD * np.cross(along / length, down)
        bend = CURL_RAD + droop @ to_palm
        wrist = pose.place(hand.joint, body.local(hand.start))[:, 2]
        over = (wrist - ground_m - THICKNESS_M) / length
        ahead, palm = -down @ (along / length), -down @ DOWN
        bend = steadied(_above_ground(bend, over, ahead, palm), time_s)
        bend = _above_ground(bend, over, ahead, palm)
        turns[name] = exponential(bend[:, None] * to_palm) @ exponential((droop @ aside)[:, None] * aside)
    return turns


def _above_ground(bend: Array, over: Array, ahead: Array, palm: Array) -> Array:
    """The bends (F,) that keep fingertips above the ground, as far as the wrists let them.

    Args:
        bend: (F,) the relaxed ones [rad].
        over: (F,) height of the wrist above the ground, in lengths of the hand.
        ahead: (F,) upward component of the forearm's direction; of a straight hand's.
        palm: (F,) upward component of the direction that the palm faces.
    """
    # A tip rises by ahead cos(bend) + palm sin(bend), least where the hand is as steep as its hinge lets it.
    steepness = np.hypot(ahead, palm)
    steepest = np.arctan2(-palm, -ahead)
    closeness = np.clip(over / np.maximum(steepness, 1e-6), -1.0, 1.0)
    apart = np.arccos(closeness)
    back = np.minimum(bend, steepest - apart)
    forth = np.maximum(bend, steepest + apart)
    passing = np.abs(np.remainder(bend - steepest + np.pi, 2.0 * np.pi) - np.pi) < apart
    kept = np.where(steepest > BACK_FROM_RAD, back, forth)
    return np.clip(np.where(passing, kept, bend), -BACK_RAD, TO_PALM_RAD)
