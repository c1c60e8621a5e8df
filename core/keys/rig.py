"""Forward kinematics of an armature's channels: bones with their own rotation modes and their points.

Reducing keys changes channels; its effect on the body is measured in the world, after the values have been
read as Blender reads them (quaternions and axes are normalized, Euler angles turn in their order) and passed
on from parent to child.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array, IndexArray

NO_TURN = "NONE"  # rotation mode of a bone that is placed and not turned


@dataclass(frozen=True, eq=False)
class RigBone:
    """A bone that turns, with the points rigidly fixed to it."""

    name: str
    parent: int  # index; -1 for the root
    mode: str
    """QUATERNION (w, x, y, z), AXIS_ANGLE (angle, x, y, z), the order of Euler angles such as XYZ, or
    `NO_TURN` for a bone whose rotation has no channels."""
    left: Array  # (3, 3) `left @ rotation @ right` is the joint's frame in its turner's frame
    right: Array  # (3, 3)
    origin: Array  # (3,) the joint in its parent's frame [m], of a root in the world, without location
    points: Array  # (N, 3) fixed points in its joint's frame [m]: its end, and those of rigid leaves
    location_axes: Array | None = None
    """(3, 3) takes its location channels to the parent's joint's frame, for a root to the world; None for a
    bone that has none."""
    turned_by: int | None = None  # index of the bone that turns it, -1 for none; None for its parent

    @property
    def turner(self) -> int:
        """Index of the bone in whose joint's frame it turns; -1 for none."""
        return self.parent if self.turned_by is None else self.turned_by


@dataclass(frozen=True, eq=False)
class Rig:
    """Bones, those that carry others before them.

    A bone's *values* over F frames are (F, C): its rotation channels, followed by three of location where it
    has `location_axes`.
    """

    bones: tuple[RigBone, ...]

    @cached_property
    def subtrees(self) -> tuple[tuple[int, ...], ...]:
        """For each bone the indices of itself and all that it carries or turns, parents first."""
        found: list[set[int]] = [{index} for index in range(len(self.bones))]
        for index in reversed(range(len(self.bones))):
            for above in {self.bones[index].parent, self.bones[index].turner} - {-1}:
                found[above] |= found[index]
        return tuple(tuple(sorted(indices)) for indices in found)

    @cached_property
    def point_slices(self) -> tuple[slice, ...]:
        """Slice of each bone's joint and points among all points."""
        ends = np.cumsum([1 + len(bone.points) for bone in self.bones])
        starts = [0, *ends[:-1]]
        return tuple(slice(int(a), int(b)) for a, b in zip(starts, ends, strict=True))

    def pose(self, values: list[Array]) -> "RigPose":
        """Forward kinematics of every bone's values."""
        frames, count = len(values[0]), self.point_slices[-1].stop
        pose = RigPose(np.empty((len(self.bones), frames, 3, 3)), np.empty((frames, count, 3)))
        for index, own in enumerate(values):
            self._place(pose, index, *self._local(index, own))
        return pose

    def pose_changed(
        self, pose: "RigPose", frames: slice | IndexArray, changed: dict[int, Array]
    ) -> "RigPose":
        """The pose at some frames when some bones take other values (N, C) there."""
        part = RigPose(pose.rotation[:, frames].copy(), pose.points[frames].copy())
        touched = sorted({index for bone in changed for index in self.subtrees[bone]})
        local = {
            index: self._local(index, changed[index])
            if index in changed
            else (pose.local(self, index, frames), pose.place(self, index, frames))
            for index in touched
        }
        for index in touched:
            self._place(part, index, *local[index])
        return part

    def _place(self, pose: "RigPose", index: int, turn: Array, place: Array) -> None:
        """Put a bone's joint and points where its turn and place in the frames of others have them."""
        bone, where = self.bones[index], self.point_slices[index]
        own = turn if bone.turner < 0 else pose.rotation[bone.turner] @ turn
        pose.rotation[index] = own
        if bone.parent >= 0:
            start = pose.points[:, self.point_slices[bone.parent].start]
            place = start + (pose.rotation[bone.parent] @ place[..., None])[..., 0]
        pose.points[:, where.start] = place
        joint = pose.points[:, where.start, None]
        pose.points[:, where.start + 1 : where.stop] = joint + bone.points @ np.swapaxes(own, -1, -2)

    def _local(self, index: int, values: Array) -> tuple[Array, Array]:
        """A bone's turn (F, 3, 3) and place, (F, 3) or (3,) without location, in the frames of others."""
        bone = self.bones[index]
        place = bone.origin
        if bone.location_axes is not None:
            place = bone.origin + values[:, -3:] @ bone.location_axes.T
        turn = rotation_matrices(values[:, : channel_count(bone.mode)], bone.mode)
        return np.asarray(bone.left @ turn @ bone.right), place


@dataclass(frozen=True, eq=False)
class RigPose:
    """Joints and points of a rig in F frames."""

    rotation: Array  # (B, F, 3, 3) each bone's joint's frame in the world
    points: Array  # (F, P, 3) joints and ends in the world [m], in the order of `Rig.point_slices`

    def local(self, rig: Rig, index: int, frames: slice | IndexArray) -> Array:
        """(N, 3, 3) a bone's joint's frame in that of the bone that turns it."""
        own = self.rotation[index, frames]
        above = rig.bones[index].turner
        return own if above < 0 else np.swapaxes(self.rotation[above, frames], -1, -2) @ own

    def place(self, rig: Rig, index: int, frames: slice | IndexArray) -> Array:
        """A bone's joint in its parent's joint's frame: (N, 3), or (3,) where it has no location."""
        bone = rig.bones[index]
        if bone.location_axes is None:
            return bone.origin
        own = self.points[frames, rig.point_slices[index].start]
        if bone.parent < 0:
            return own
        start = self.points[frames, rig.point_slices[bone.parent].start]
        away = np.swapaxes(self.rotation[bone.parent, frames], -1, -2) @ (own - start)[..., None]
        return np.asarray(away[..., 0])


def channel_count(mode: str) -> int:
    """Number of rotation channels of a rotation mode."""
    return {"QUATERNION": 4, "AXIS_ANGLE": 4, NO_TURN: 0}.get(mode, 3)


def rotation_matrices(channels: Array, mode: str) -> Array:
    """Rotations (F, 3, 3) of channels (F, C) in a rotation mode, as Blender evaluates them."""
    from scipy.spatial.transform import Rotation

    if mode == NO_TURN:
        return np.broadcast_to(np.eye(3), (len(channels), 3, 3))
    if mode == "QUATERNION":
        return np.asarray(Rotation.from_quat(channels[:, [1, 2, 3, 0]]).as_matrix())
    if mode == "AXIS_ANGLE":
        length = np.linalg.norm(channels[:, 1:], axis=-1, keepdims=True)
        axis = channels[:, 1:] / np.maximum(length, 1e-12)
        return np.asarray(Rotation.from_rotvec(channels[:, :1] * axis).as_matrix())
    order = ["XYZ".index(letter) for letter in mode]
    # Blender's XYZ turns about the fixed x first, then y, then z: scipy's lower case.
    return np.asarray(Rotation.from_euler(mode.lower(), channels[:, order]).as_matrix())
