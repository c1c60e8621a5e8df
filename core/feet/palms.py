"""Hands as they are seen: the forearms' pronation, how hands are bent, and the curls of their fingers.

None of it moves a principal point. What is believed is a path through the looks at a hand over time, by
Viterbi: they may be of another hand, take the palm for the back, or jump. A look is believed as far as its
mirror image says the same and it is one of that side. Between and instead of such looks the pronation stays
as it was estimated, as at keyframes that a person has posed, and fingers are relaxed.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array, IndexArray
from ..body.fingers import RELAXED_RAD, SURE, Hands
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.rotations import exponential, hinge, logarithm, to_quaternions
from ..body.skeleton import FINGERS, SIDES
from ..camera.camera import Camera
from ..detect.keypoints import FACING, Keypoints
from ..numerics.markov_chain import cheapest_path
from ..terms.head import viewer_axes

LOOKS = 2
UNSEEN_COST = 4.0  # of believing neither look
AGREEING_RAD = np.radians(20.0)  # by how much two looks at the same hand differ that are right
SWING_RAD = np.radians(45.0)  # by how much hands are bent against forearms
SPEED_RAD_S = np.radians(400.0)  # at which hands turn over
SMOOTH_S = 0.1
NATURAL = 0.2  # weight of what is natural, in sure looks
POSED_S = 0.3  # time from a posed keyframe in which it comes back
LARGEST_RAD = np.radians(100.0)


def seen_hands(
    body: Body,
    posture: Posture,
    time_s: Array,
    keypoints: Keypoints,
    camera: Camera,
    posed: Sequence[int] = (),
) -> tuple[Posture, Hands | None]:
    """The postures (F,) with palms as hands are seen, and how these are bent and closed; None of no looks.

    `posed` are frames of keyframes that a person posed.
    """
    if not np.isfinite(keypoints.hands).any():
        return posture, None
    angles, apart_s = np.array(posture.angles), np.full(len(time_s), np.inf)
    for index in posed:
        apart_s = np.minimum(apart_s, np.abs(time_s - time_s[index]))
    free = np.clip(apart_s / POSED_S, 0.0, 1.0)
    pose, skeleton = body.pose(posture), body.skeleton
    shape = (len(time_s), len(SIDES))
    curls = np.broadcast_to(RELAXED_RAD, (*shape, len(FINGERS))).copy()
    bend, sure = np.zeros((*shape, 3)), np.zeros(shape)
    for row, side in enumerate(SIDES):
        joint = skeleton.joint_index(f"forearm.{side}")
        column = skeleton.hinge_joints.index(joint)
        forearm, axis = pose.rotation[:, skeleton.joints[joint].parent], skeleton.hinge_axes[column]
        hands = keypoints.hands[:, row]
        seen = np.flatnonzero(np.isfinite(hands).all(axis=-1))
        if not len(seen):
            continue
        looks = hands[seen, 2:].reshape(len(seen), LOOKS, -1)
        shown = viewer_axes(camera, hands[seen, :2], seen)[:, None] @ exponential(looks[..., :3]) @ FACING
        # In a forearm without pronation, by each look; and about its axis alone.
        turn = np.swapaxes(forearm[seen], -1, -2)[:, None] @ shown
        own = to_quaternions(turn)
        twist = np.angle(np.exp(2j * np.arctan2(own[..., 1:] @ axis, own[..., 0])))
        swing = logarithm(hinge(-axis, twist) @ turn)
        path = _path(twist, np.linalg.norm(swing, axis=-1), looks, time_s[seen])
        kept = np.flatnonzero(path < LOOKS)
        believed = kept, path[kept]
        doubt = _apart(looks[:, 0, :3], looks[:, 1, :3])[kept] / AGREEING_RAD
        weight = np.exp(-0.5 * ((time_s[:, None] - time_s[seen[kept]]) / SMOOTH_S) ** 2)
        weight = weight * np.exp(-0.5 * doubt**2) * looks[believed][:, 3:5].prod(axis=1)
        total = weight.sum(axis=1)
        sure[:, row] = total / (total + NATURAL)
        mean, full = weight / np.maximum(total, 1e-12)[:, None], np.minimum(sure[:, row] / SURE, 1.0)
        natural = angles[:, column]
        change = full * (mean * (twist[believed] - natural[:, None])).sum(axis=1)
        angles[:, column] = np.clip(natural + free * change, -LARGEST_RAD, LARGEST_RAD)
        bend[:, row] = mean @ swing[believed]
        curls[:, row] += full[:, None] * (mean @ (looks[believed][:, 5:] - RELAXED_RAD))
    return replace(posture, angles=angles), Hands(curls, bend, sure)


def _path(twist: Array, swing: Array, looks: Array, time_s: Array) -> IndexArray:
    """(S,) which look is believed, `LOOKS` for neither."""
    beyond = np.maximum(np.abs(twist) - LARGEST_RAD, 0.0)
    agreement = _apart(looks[:, 0, :3], looks[:, 1, :3])[:, None] / AGREEING_RAD
    cost = -np.log(np.maximum(looks[..., 3] * looks[..., 4], 1e-3))
    cost = cost + 0.5 * (swing / SWING_RAD) ** 2 + 0.5 * (beyond / AGREEING_RAD) ** 2
    cost = cost + np.minimum(0.5 * agreement**2, 2.0)
    own = np.column_stack([cost, np.full(len(cost), UNSEEN_COST)])
    steps = []
    for now, then, step_s in zip(twist[:-1], twist[1:], np.diff(time_s), strict=True):
        jump = np.abs(then[None] - now[:, None]) / np.hypot(AGREEING_RAD, SPEED_RAD_S * step_s)
        between = np.zeros((LOOKS + 1, LOOKS + 1))
        between[:LOOKS, :LOOKS] = np.minimum(0.5 * jump**2, 4.0)
        between[LOOKS, :LOOKS] = between[:LOOKS, LOOKS] = 0.5
        steps.append(between)
    return cheapest_path(list(own), steps.__getitem__)


def _apart(first: Array, second: Array) -> Array:
    """Angles (...) between turns given as rotation vectors (..., 3) [rad]."""
    turn = np.swapaxes(exponential(first), -1, -2) @ exponential(second)
    return np.asarray(np.linalg.norm(logarithm(turn), axis=-1))
