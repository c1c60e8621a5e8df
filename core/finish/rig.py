"""Forward kinematics of an armature's channels: bones with their own rotation modes and their points.

Reducing keys changes channels; its effect on the body is measured in the world, after the values have been
read as Blender reads them (quaternions and axes are normalized, Euler angles turn in their order) and passed
on from parent to child.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from ..arrays import Array

LEAST_LENGTH = 1e-12


@dataclass(frozen=True, eq=False)
class RigBone:
    """A bone that turns, with the points rigidly fixed to it."""

    name: str
    parent: int
    """Index of its parent; -1 for the root."""
    mode: str
    """QUATERNION (w, x, y, z), AXIS_ANGLE (angle, x, y, z) or the order of Euler angles such as XYZ."""
    left: Array
    """(3, 3) and `right`: `left @ rotation @ right` is the joint's frame in its parent's joint's frame."""
    right: Array
    """(3, 3)."""
    origin: Array
    """(3,) the joint in the parent's joint's frame [m]; unused for the root."""
    points: Array
    """(N, 3) points fixed to the bone, in its joint's frame [m]: its end, and the ends of rigid leaves."""


@dataclass(frozen=True, eq=False)
class Rig:
    """Bones, parents first; the first is the root.

    A bone's *values* over F frames are (F, C): its rotation channels, for the root followed by three of
    location.
    """

    bones: tuple[RigBone, ...]
    root_turn: Array
    """(3, 3) takes the root's location channels to the world ..."""
    root_origin: Array
    """(3,) ... from here [m]."""

    @cached_property
    def subtrees(self) -> tuple[tuple[int, ...], ...]:
        """For each bone the indices of itself and all its descendants, parents first."""
        found: list[list[int]] = [[index] for index in range(len(self.bones))]
        for index in range(len(self.bones)):
            above = self.bones[index].parent
            while above >= 0:
                found[above].append(index)
                above = self.bones[above].parent
        return tuple(tuple(sorted(indices)) for indices in found)

    @cached_property
    def point_slices(self) -> tuple[slice, ...]:
        """Slice of each bone's joint and points among all points."""
        ends = np.cumsum([1 + len(bone.points) for bone in self.bones])
        starts = [0, *ends[:-1]]
        return tuple(slice(int(a), int(b)) for a, b in zip(starts, ends, strict=True))

    def pose(self, values: list[Array]) -> "RigPose":
        """Forward kinematics of every bone's values."""
        frames = len(values[0])
        count = self.point_slices[-1].stop
        pose = RigPose(np.empty((len(self.bones), frames, 3, 3)), np.empty((frames, count, 3)))
        self._fill(pose, values, range(len(self.bones)))
        return pose

    def pose_changed(self, pose: "RigPose", frames: slice, changed: dict[int, Array]) -> "RigPose":
        """The pose at some frames when some bones take other values (N, C) there."""
        part = RigPose(pose.rotation[:, frames].copy(), pose.points[frames].copy())
        touched = sorted({index for bone in changed for index in self.subtrees[bone]})
        local = {index: pose.local(self, index, frames) for index in touched if index not in changed}
        for index in touched:
            turn = self._turn(index, changed[index]) if index in changed else local[index]
            location = self._root_location(changed[index]) if index == 0 and index in changed else None
            self._fill_bone(part, index, turn, location)
        return part

    def _fill(self, pose: "RigPose", values: list[Array], bones: range) -> None:
        for index in bones:
            location = self._root_location(values[0]) if index == 0 else None
            self._fill_bone(pose, index, self._turn(index, values[index]), location)

    def _fill_bone(self, pose: "RigPose", index: int, turn: Array, location: Array | None) -> None:
        bone, where = self.bones[index], self.point_slices[index]
        if bone.parent < 0:
            pose.rotation[index] = turn
            if location is not None:
                pose.points[:, where.start] = location
        else:
            above = pose.rotation[bone.parent]
            pose.rotation[index] = above @ turn
            start = pose.points[:, self.point_slices[bone.parent].start]
            pose.points[:, where.start] = start + above @ bone.origin
        joint = pose.points[:, where.start, None]
        pose.points[:, where.start + 1 : where.stop] = joint + bone.points @ np.swapaxes(
            pose.rotation[index], -1, -2
        )

    def _turn(self, index: int, values: Array) -> Array:
        """(F, 3, 3) the joint's frame in its parent's joint's frame."""
        bone = self.bones[index]
        channels = values[:, : channel_count(bone.mode)]
        return np.asarray(bone.left @ rotation_matrices(channels, bone.mode) @ bone.right)

    def _root_location(self, values: Array) -> Array:
        return np.asarray(self.root_origin + values[:, -3:] @ self.root_turn.T)


@dataclass(frozen=True, eq=False)
class RigPose:
    """Joints and points of a rig in F frames."""

    rotation: Array
    """(B, F, 3, 3) each bone's joint's frame in the world."""
    points: Array
    """(F, P, 3) joints and ends in the world [m], in the order of `Rig.point_slices`."""

    def local(self, rig: Rig, index: int, frames: slice) -> Array:
        """(N, 3, 3) a bone's joint's frame in its parent's."""
        own = self.rotation[index, frames]
        above = rig.bones[index].parent
        return own if above < 0 else np.swapaxes(self.rotation[above, frames], -1, -2) @ own


def channel_count(mode: str) -> int:
    """Number of rotation channels of a rotation mode."""
    return 4 if mode in ("QUATERNION", "AXIS_ANGLE") else 3


def rotation_matrices(channels: Array, mode: str) -> Array:
    """Rotations (F, 3, 3) of channels (F, C) in a rotation mode, as Blender evaluates them."""
    if mode == "QUATERNION":
        return np.asarray(Rotation.from_quat(channels[:, [1, 2, 3, 0]]).as_matrix())
    if mode == "AXIS_ANGLE":
        length = np.linalg.norm(channels[:, 1:], axis=-1, keepdims=True)
        axis = channels[:, 1:] / np.maximum(length, LEAST_LENGTH)
        return np.asarray(Rotation.from_rotvec(channels[:, :1] * axis).as_matrix())
    order = ["XYZ".index(letter) for letter in mode]
    # Blender's XYZ turns about the fixed x first, then y, then z: scipy's lower case.
    return np.asarray(Rotation.from_euler(mode.lower(), channels[:, order]).as_matrix())
