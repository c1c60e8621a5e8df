"""A body as an armature's channels show it: bones with their own rotation modes, and where their ends lie.

Reducing keys changes channels; what it does to the body shows only in the world, after the values have been
read as Blender reads them (quaternions and axes are brought to unit length, Euler angles turn in their order)
and passed on from parent to child.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from ..arrays import Array

SMALLEST_LENGTH = 1e-12


@dataclass(frozen=True, eq=False)
class RigBone:
    """A bone that turns, with what is rigidly fixed to it."""

    name: str
    parent: int
    """Position of the bone it hangs on; -1 for the root."""
    mode: str
    """QUATERNION (w, x, y, z), AXIS_ANGLE (angle, x, y, z) or the order of Euler angles such as XYZ."""
    left: Array
    """(3, 3) and `right`: `left @ rotation @ right` is the joint's frame in its parent's joint's frame."""
    right: Array
    """(3, 3)."""
    origin: Array
    """(3,) the joint in the parent's joint's frame [m]; unused for the root."""
    points: Array
    """(N, 3) what is fixed to the bone, in its joint's frame [m]: its end, and the ends of rigid leaves."""


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
    def below(self) -> tuple[tuple[int, ...], ...]:
        """For each bone, itself and all bones that hang on it, parents first."""
        found: list[list[int]] = [[index] for index in range(len(self.bones))]
        for index in range(len(self.bones)):
            above = self.bones[index].parent
            while above >= 0:
                found[above].append(index)
                above = self.bones[above].parent
        return tuple(tuple(sorted(indices)) for indices in found)

    @cached_property
    def point_slices(self) -> tuple[slice, ...]:
        """Where each bone's joint and points lie among all."""
        ends = np.cumsum([1 + len(bone.points) for bone in self.bones])
        starts = [0, *ends[:-1]]
        return tuple(slice(int(a), int(b)) for a, b in zip(starts, ends, strict=True))

    def show(self, values: list[Array]) -> "Shown":
        """Forward kinematics of every bone's values."""
        frames = len(values[0])
        count = self.point_slices[-1].stop
        shown = Shown(np.empty((len(self.bones), frames, 3, 3)), np.empty((frames, count, 3)))
        self._fill(shown, values, range(len(self.bones)))
        return shown

    def show_changed(self, shown: "Shown", frames: slice, changed: dict[int, Array]) -> "Shown":
        """What is shown at some frames when some bones take other values (N, C) there."""
        part = Shown(shown.rotation[:, frames].copy(), shown.points[frames].copy())
        touched = sorted({index for bone in changed for index in self.below[bone]})
        local = {index: shown.local(self, index, frames) for index in touched if index not in changed}
        for index in touched:
            turn = self._turn(index, changed[index]) if index in changed else local[index]
            place = self._root_place(changed[index]) if index == 0 and index in changed else None
            self._fill_bone(part, index, turn, place)
        return part

    def _fill(self, shown: "Shown", values: list[Array], bones: range) -> None:
        for index in bones:
            place = self._root_place(values[0]) if index == 0 else None
            self._fill_bone(shown, index, self._turn(index, values[index]), place)

    def _fill_bone(self, shown: "Shown", index: int, turn: Array, place: Array | None) -> None:
        bone, where = self.bones[index], self.point_slices[index]
        if bone.parent < 0:
            shown.rotation[index] = turn
            if place is not None:
                shown.points[:, where.start] = place
        else:
            above = shown.rotation[bone.parent]
            shown.rotation[index] = above @ turn
            start = shown.points[:, self.point_slices[bone.parent].start]
            shown.points[:, where.start] = start + above @ bone.origin
        joint = shown.points[:, where.start, None]
        shown.points[:, where.start + 1 : where.stop] = joint + bone.points @ np.swapaxes(
            shown.rotation[index], -1, -2
        )

    def _turn(self, index: int, values: Array) -> Array:
        """(F, 3, 3) the joint's frame in its parent's joint's frame."""
        bone = self.bones[index]
        channels = values[:, : channel_count(bone.mode)]
        return np.asarray(bone.left @ rotation_matrices(channels, bone.mode) @ bone.right)

    def _root_place(self, values: Array) -> Array:
        return np.asarray(self.root_origin + values[:, -3:] @ self.root_turn.T)


@dataclass(frozen=True, eq=False)
class Shown:
    """What a rig shows in F frames."""

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
    """Rotations (F, 3, 3) that channels (F, C) of a rotation mode show in Blender."""
    if mode == "QUATERNION":
        return np.asarray(Rotation.from_quat(channels[:, [1, 2, 3, 0]]).as_matrix())
    if mode == "AXIS_ANGLE":
        length = np.linalg.norm(channels[:, 1:], axis=-1, keepdims=True)
        axis = channels[:, 1:] / np.maximum(length, SMALLEST_LENGTH)
        return np.asarray(Rotation.from_rotvec(channels[:, :1] * axis).as_matrix())
    order = ["XYZ".index(letter) for letter in mode]
    # Blender's XYZ turns about the fixed x first, then y, then z: scipy's lower case.
    return np.asarray(Rotation.from_euler(mode.lower(), channels[:, order]).as_matrix())
