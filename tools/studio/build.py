"""A performer's own build: joints that lie beside the skeleton's, as those of every living person do.

The posture of the skeleton decides where limbs point; the performer's joints are moved from the skeleton's by
a smooth function of that posture, by about a centimeter, hips and knees by up to two. Mesh and truth both
follow, so no posture of the skeleton reaches all thirteen points. The ankles keep their places, since feet
stand on the floor. The amounts are of the size by which hip and shoulder centers differ between people and
move under the skin; they are no particular person's.
"""

from dataclasses import dataclass

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.human import WAIST_HEIGHT
from keymark.core.body.kinematics import Body, Pose
from keymark.core.body.rotations import exponential, logarithm

SIDES = ("L", "R")
Placed = dict[str, tuple[Array, Array]]
"""World rotations (T, 3, 3) and origins (T, 3) of movers, by name."""
JOINT_OF_POINT = {"head": "neck", "wrist": "forearm"}
"""The joint that moves a point, where it has another name."""


@dataclass(frozen=True)
class Build:
    """How far joints lie from the skeleton's [m]; the defaults are one person's."""

    hip: tuple[float, float, float] = (0.010, 0.006, -0.014)
    """Outward, backward and upward from the skeleton's hip, in the pelvis."""
    hip_rise: float = 0.008
    """Further upward where the thigh is level."""
    knee_roll: float = 0.012
    """Backward in the thigh where the knee is bent by a right angle."""
    shoulder: tuple[float, float, float] = (0.0, 0.008, -0.008)
    """Outward, backward and upward from the skeleton's shoulder, in the chest, with a hanging arm."""
    shoulder_raised: tuple[float, float, float] = (-0.012, 0.0, 0.026)
    """The same, added with the arm overhead."""
    shoulder_reaching: float = 0.016
    """Forward where the arm points ahead."""
    spine: tuple[float, float, float] = (0.08, 0.40, 0.86)
    """Heights of the three places in which the spine bends by a third each, as shares of the trunk."""

    def moved(self, body: Body, pose: Pose) -> dict[str, Array]:
        """World displacement (T, 3) [m] of joints, by name; joints that are missing stay."""
        joint = body.skeleton.joint_index
        turn = {j.name: pose.rotation[:, joint(j.name)] for j in body.skeleton.joints}
        spine = self._spine(body.actor.segments_m["trunk"], turn["pelvis"], turn["waist"])
        moved = {"waist": spine, "neck": spine}
        for side, out in zip(SIDES, (1.0, -1.0), strict=True):
            aside = np.array([out, 1.0, 1.0])
            arm = _in(turn["waist"], out * turn[f"shoulder.{side}"][..., 0])
            raised = 0.5 * (1.0 + arm[:, 2:])
            own = np.array(self.shoulder) + raised * np.array(self.shoulder_raised)
            own = own * aside + arm[:, 1:2] * np.array([0.0, self.shoulder_reaching, 0.0])
            shoulder = spine + _out(turn["waist"], own)
            moved[f"girdle.{side}"] = 0.5 * (spine + shoulder)
            moved |= {f"{name}.{side}": shoulder for name in ("shoulder", "elbow", "forearm")}
            thigh = -turn[f"hip.{side}"][..., 2]
            shin = -turn[f"knee.{side}"][..., 2]
            level = 1.0 + _in(turn["pelvis"], thigh)[:, 2:]
            hip = _out(turn["pelvis"], np.array(self.hip) * aside + level * [0.0, 0.0, self.hip_rise])
            bent = 1.0 - np.sum(thigh * shin, axis=-1, keepdims=True)
            moved[f"hip.{side}"] = hip
            moved[f"knee.{side}"] = 0.5 * hip + self.knee_roll * bent * turn[f"hip.{side}"][..., 1]
        return moved

    def points(self, body: Body, pose: Pose) -> Array:
        """(T, P, 3) the performer's principal points [m]."""
        points, moved = body.points(pose).copy(), self.moved(body, pose)
        for column, name in enumerate(body.skeleton.point_names):
            part, dot, side = name.partition(".")
            points[:, column] += moved.get(JOINT_OF_POINT.get(part, part) + dot + side, 0.0)
        return points

    def placed(self, body: Body, pose: Pose, movers: Placed) -> Placed:
        """The movers of the skeleton at the performer's joints, thighs and shins turned to join them."""
        moved = self.moved(body, pose)
        placed = {name: (turn, place + moved.get(name, 0.0)) for name, (turn, place) in movers.items()}
        for side in SIDES:
            knee = moved[f"knee.{side}"]
            for names, start, end in (
                ((f"hip.{side}",), moved[f"hip.{side}"], knee),
                ((f"knee.{side}", f"shin.{side}"), knee, 0.0 * knee),
            ):
                segment = "thigh" if names[0].startswith("hip") else "shin"
                first, last = body.segment_ends(pose, f"{segment}.{side}")
                turn = _between(last - first, last + end - first - start)
                for name in names:
                    placed[name] = (turn @ movers[name][0], movers[name][1] + start)
        return placed

    def _spine(self, length: float, pelvis: Array, chest: Array) -> Array:
        """(T, 3) how far the chest is from where one joint in the waist would put it."""
        bend = np.swapaxes(pelvis, -1, -2) @ chest
        third = exponential(logarithm(bend) / 3.0)
        place, turn, below = np.zeros((len(bend), 3)), np.broadcast_to(np.eye(3), bend.shape), 0.0
        for height in (*self.spine, 1.0):
            place, below = place + (height - below) * turn[..., 2], height
            turn = turn @ third
        single = np.array([0.0, 0.0, WAIST_HEIGHT]) + (1.0 - WAIST_HEIGHT) * bend[..., 2]
        return _out(pelvis, length * (place - single))


def _in(turn: Array, vectors: Array) -> Array:
    """World vectors (T, 3) in frames (T, 3, 3)."""
    return np.asarray(np.einsum("tij,ti->tj", turn, vectors))


def _out(turn: Array, vectors: Array) -> Array:
    """Vectors (T, 3) of frames (T, 3, 3) in the world."""
    return np.asarray(np.einsum("tij,tj->ti", turn, vectors))


def _between(first: Array, second: Array) -> Array:
    """(T, 3, 3) the shortest turns from directions (T, 3) to others that are close to them."""
    first = first / np.linalg.norm(first, axis=-1, keepdims=True)
    second = second / np.linalg.norm(second, axis=-1, keepdims=True)
    across = np.cross(first, second)
    sine = np.linalg.norm(across, axis=-1, keepdims=True)
    angle = np.arctan2(sine, np.sum(first * second, axis=-1, keepdims=True))
    return exponential(across * angle / np.maximum(sine, 1e-12))
