"""Poses that controls are to have so that the bones with roles have theirs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...body import rotations
from ...numerics.vectors import unit
from ..character_motion import CharacterMotion
from .control_plan import ControlKind, PlannedControl

SHORTEST_POLE = 0.25
"""Least distance of a pole from its joint, in lengths of the limb."""


@dataclass(frozen=True, eq=False)
class PoleSetting:
    """Where a pole belongs."""

    distance: float
    """Its distance from elbow or knee, in the armature's units."""
    offset_rad: float
    """Angle from the direction of the pole to that of elbow or knee, about the line from the limb's root to
    its end."""


def control_targets(
    planned: Sequence[PlannedControl],
    motion: CharacterMotion,
    offsets: Mapping[str, Array],
    poles: Mapping[str, PoleSetting],
    limbs: Mapping[str, tuple[str, str, str]],
) -> dict[str, Array]:
    """(F, 4, 4) by name the pose that each control is to have in the armature's space.

    Args:
        planned: The controls.
        motion: The poses of the bones with roles.
        offsets: (4, 4) by control the pose of its bone in its own axes.
        poles: The poles by name.
        limbs: The bones at the three joints of each limb.
    """
    targets = {}
    for control in planned:
        if control.kind is ControlKind.ROOT:
            if motion.root is not None:
                targets[control.name] = motion.root
        elif control.kind is ControlKind.POLE:
            limb = str(control.limb)
            places = [motion.poses[bone][:, :3, 3] for bone in limbs[limb]]
            targets[control.name] = pole_poses(places, motion.bends[limb], poles[control.name])
        else:
            targets[control.name] = motion.poses[control.bone] @ np.linalg.inv(offsets[control.name])
    return targets


def pole_poses(joints: Sequence[Array], bend: Array, setting: PoleSetting) -> Array:
    """(F, 4, 4) places of a pole, as matrices.

    A pole without an offset lies beyond elbow or knee; others are as far from the line between the limb's
    root and its end.

    Args:
        joints: (F, 3) the limb's root, its elbow or knee, and its end.
        bend: (F, 3) unit vector from the line between root and end toward elbow or knee.
        setting: The pole.
    """
    root, middle, end = joints
    axis = unit(end - root)
    foot = root + np.sum((middle - root) * axis, axis=-1, keepdims=True) * axis
    out = np.linalg.norm(middle - foot, axis=-1, keepdims=True)
    turn = rotations.exponential(-setting.offset_rad * axis)
    poses = np.tile(np.eye(4), (len(bend), 1, 1))
    poses[:, :3, 3] = foot + (out + setting.distance) * (turn @ bend[..., None])[..., 0]
    return poses


def pole_offset(root: Array, middle: Array, end: Array, pole: Array) -> float:
    """Angle [rad] from a pole's direction to that of the joint that it guides, about the limb's line.

    Args:
        root: (3,) the limb's root.
        middle: (3,) elbow or knee.
        end: (3,) the limb's end.
        pole: (3,).
    """
    axis = unit(end - root)
    toward = [point - root - ((point - root) @ axis) * axis for point in (pole, middle)]
    return float(np.arctan2(np.cross(toward[0], toward[1]) @ axis, toward[0] @ toward[1]))
