"""Links of the body whose depth a network guesses: how much farther away one end is than the other.

A network that guesses an arm too far back has the wrist off by what the elbow is off by, and more. Link by
link its errors are smaller and nearly independent. Depths are those of the points of a `KeypointModel`, so
that a nose is compared with a nose.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Pose
from ..body.posture import Posture
from ..body.skeleton import SIDES
from .keypoints import KeypointModel

Ends = tuple[str, ...]
"""Body points whose middle is the end of a link."""
HIPS: Ends = ("hip.L", "hip.R")
SHOULDERS: Ends = ("shoulder.L", "shoulder.R")
HEADS: tuple[Ends, ...] = (("head",), ("nose",), ("ear.L", "ear.R"))
"""What may stand for the head, the first that a layout has."""
LIMBS = (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle"))


@dataclass(frozen=True, eq=False)
class DepthLinks:
    """L links between the N points of a model."""

    names: tuple[str, ...]
    """(L,) without the side, which links on both sides share."""
    sources: tuple[str, ...]
    """(L,) whose points they join."""
    ends: Array
    """(L, N) weights of the points: 1 in all for the far end, -1 for the near one."""

    @classmethod
    def between(cls, names: Sequence[str], sources: Sequence[str]) -> "DepthLinks":
        """All links between points that one source has.

        Args:
            names: (N,) the body points.
            sources: (N,) what saw each.
        """
        found: list[tuple[str, str, Array]] = []
        for source in dict.fromkeys(sources):
            index = {n: i for i, (n, s) in enumerate(zip(names, sources, strict=True)) if s == source}
            for name, far, near in _links(index):
                weights = np.zeros(len(names))
                for points, sign in ((far, 1.0), (near, -1.0)):
                    weights[[index[point] for point in points]] = sign / len(points)
                found.append((name, source, weights))
        ends = np.array([weights for _, _, weights in found]).reshape(len(found), len(names))
        return cls(tuple(name for name, _, _ in found), tuple(source for _, source, _ in found), ends)

    def lengths_m(self, model: KeypointModel) -> Array:
        """(L,) the links' lengths at rest [m]."""
        skeleton = model.body.skeleton
        rest = model.body.pose(Posture.from_vector(skeleton, np.zeros((1, skeleton.dof_count))))
        return np.linalg.norm(self.ends @ model.world(rest)[0], axis=-1)

    def guessed(self, depth: Array) -> Array:
        """(F, L) depths of the links by the points' guessed ones (F, N) [m]; NaN where an end is missing."""
        known = np.isfinite(depth)
        missing = (~known).astype(float) @ (self.ends != 0.0).T.astype(float)
        return np.where(missing == 0.0, np.where(known, depth, 0.0) @ self.ends.T, np.nan)

    def depths(self, model: KeypointModel, pose: Pose, frame: IndexArray) -> Array:
        """(F, L) depths of the links at F poses [m]; `frame` (F,) as in the clip."""
        return np.asarray(model.camera.depth(model.world(pose), frame[:, None]) @ self.ends.T)

    def jacobian(self, model: KeypointModel, pose: Pose, frame: IndexArray) -> Array:
        """(F, L, D) derivative of the depths by the posture's tangent."""
        used = np.flatnonzero(self.ends.any(axis=0))
        world = model.world(pose)[:, used]
        axis = model.camera.depth_jacobian(world, frame[:, None])
        return np.asarray(self.ends[:, used] @ pose.along_jacobian(model.joint[used], world, axis))


def _links(index: dict[str, int]) -> list[tuple[str, Ends, Ends]]:
    """Name, far and near end of the links between the points of one source."""
    head = next((ends for ends in HEADS if all(point in index for point in ends)), ())
    wanted: list[tuple[str, Ends, Ends]] = [
        ("hips", HIPS[:1], HIPS[1:]),
        ("shoulders", SHOULDERS[:1], SHOULDERS[1:]),
        ("trunk", SHOULDERS, HIPS),
        ("head", head, SHOULDERS),
    ]
    for near, far in LIMBS:
        wanted += [(far, (f"{far}.{side}",), (f"{near}.{side}",)) for side in SIDES]
    return [
        (name, far, near)
        for name, far, near in wanted
        if far and all(point in index for point in (*far, *near))
    ]
