"""Palms that face where they are seen to: the forearms' pronation, which moves none of the principal points.

What is believed is a path through the looks at a hand over time, by Viterbi: they may be of another hand,
take the palm for the back, or jump. A look is believed as far as its mirror image says the same. Between and
instead of such looks the pronation stays as it was estimated, as at keyframes that a person has posed.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.rotations import exponential, to_quaternions
from ..body.skeleton import SIDES
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..numerics.markov_chain import cheapest_path
from ..terms.head import FACING, viewer_axes

LOOKS = 2
UNSEEN_COST = 4.0  # of believing neither look
AGREEING_RAD = np.radians(20.0)  # by how much two looks at the same hand differ that are right
SWING_RAD = np.radians(45.0)  # by how much hands are bent against forearms
SPEED_RAD_S = np.radians(400.0)  # at which hands turn over
SMOOTH_S = 0.1
NATURAL = 0.2  # weight of the pronation that was estimated, in sure looks
POSED_S = 0.3  # time from a posed keyframe in which it comes back
LARGEST_RAD = np.radians(100.0)


def seen_palms(
    body: Body,
    posture: Posture,
    time_s: Array,
    keypoints: Keypoints,
    camera: Camera,
    posed: Sequence[int] = (),
) -> Posture:
    """The postures (F,) with palms as hands are seen; `posed` are frames of keyframes that a person posed."""
    if keypoints.hands is None:
        return posture
    angles, apart_s = np.array(posture.angles), np.full(len(time_s), np.inf)
    for index in posed:
        apart_s = np.minimum(apart_s, np.abs(time_s - time_s[index]))
    free = np.clip(apart_s / POSED_S, 0.0, 1.0)
    pose, skeleton = body.pose(posture), body.skeleton
    for row, side in enumerate(SIDES):
        joint = skeleton.joint_index(f"forearm.{side}")
        column = skeleton.hinge_joints.index(joint)
        forearm = pose.rotation[:, skeleton.joints[joint].parent]
        hands = np.asarray(keypoints.hands)[:, row]
        seen = np.flatnonzero(np.isfinite(hands).all(axis=-1))
        if not len(seen):
            continue
        twist, swing, looks = _twists(hands[seen], camera, seen, forearm[seen], skeleton.hinge_axes[column])
        path = _path(twist, swing, looks, time_s[seen])
        kept = np.flatnonzero(path < LOOKS)
        sure = np.exp(-0.5 * (_apart(looks[:, 0, :3], looks[:, 1, :3])[kept] / AGREEING_RAD) ** 2)
        sure *= looks[kept, path[kept], 3]
        believed = twist[kept, path[kept]]
        weight = np.exp(-0.5 * ((time_s[:, None] - time_s[seen[kept]]) / SMOOTH_S) ** 2) * sure
        natural = angles[:, column]
        off = believed - natural[:, None]
        change = (weight * off).sum(axis=1) / (weight.sum(axis=1) + NATURAL)
        angles[:, column] = np.clip(natural + free * change, -LARGEST_RAD, LARGEST_RAD)
    return replace(posture, angles=angles)


def _twists(
    hands: Array, camera: Camera, frame: IndexArray, forearm: Array, axis: Array
) -> tuple[Array, Array, Array]:
    """(S, 2) pronation and bend of the hand by each look [rad], and the looks (S, 2, 5)."""
    looks = hands[:, 2:].reshape(-1, LOOKS, 5)
    axes = viewer_axes(camera, hands[:, :2], frame)
    turn = axes[:, None] @ exponential(looks[..., :3]) @ FACING
    own = to_quaternions(np.swapaxes(forearm, -1, -2)[:, None] @ turn)
    along = own[..., 1:] @ axis
    length = np.hypot(own[..., 0], along)
    twist = 2.0 * np.arctan2(along, own[..., 0])
    return np.angle(np.exp(1j * twist)), 2.0 * np.arccos(np.clip(length, 0.0, 1.0)), looks


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
    return np.arccos(np.clip(0.5 * (np.trace(turn, axis1=-2, axis2=-1) - 1.0), -1.0, 1.0))
