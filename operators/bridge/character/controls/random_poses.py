"""Random poses of controls, to see what moves what; the same in every run."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from scipy.spatial.transform import Rotation

from .....core.arrays import Array
from .posing import read_poses, set_channels

SEED = 4


@dataclass(frozen=True)
class RandomPoses:
    """How many poses, and how far from rest."""

    still: int
    """Number of poses without locations, which come first."""
    moved: int
    """Number of poses with locations."""
    turn_rad: float
    """Standard deviation of rotations about each axis."""
    move: float
    """Standard deviation of locations along each axis, in the armature's units."""


def pose_at_random(
    armature_object: bpy.types.Object, controls: Sequence[str], bones: Sequence[str], poses: RandomPoses
) -> tuple[Array, Array, Array]:
    """Pose controls at random and look; inside of `posing`.

    Returns:
        Channels (S, C, 4, 4) of the controls as Blender evaluates them, their poses (S, C, 4, 4), and the
        poses (S, B, 4, 4) of bones, in the armature's space.
    """
    rng = np.random.default_rng(SEED)
    count = len(controls)
    channels, shown = [], []
    for sample in range(poses.still + poses.moved):
        matrices = np.tile(np.eye(4), (count, 1, 1))
        turns = rng.normal(0.0, poses.turn_rad, (count, 3))
        matrices[:, :3, :3] = Rotation.from_rotvec(turns).as_matrix() if count else matrices[:, :3, :3]
        if sample >= poses.still:
            matrices[:, :3, 3] = rng.normal(0.0, poses.move, (count, 3))
        set_channels(armature_object, dict(zip(controls, matrices, strict=True)))
        own, pose = read_poses(armature_object, [*controls, *bones])
        channels.append(own[:count])
        shown.append(pose)
    both = np.array(shown)
    return np.array(channels), both[:, :count], both[:, count:]
