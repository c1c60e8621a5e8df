"""The axes of the body's parts in the image, with Jacobians: where along it a part is seen.

A shift along its axis is what a part's contours cannot tell.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray
from ..body.body_volume import PieceStack
from ..body.kinematics import Pose
from ..footage.camera import Camera

FREE, UNKNOWN = -1, -2
"""What lies beyond a part's end: the background, or any of several things."""
BEYOND: dict[str, tuple[str | int, str | int]] = {
    "pelvis": (UNKNOWN, "chest"),
    "chest": ("pelvis", "head"),
    "head": ("chest", FREE),
    "upper_arm": (UNKNOWN, "forearm"),
    "forearm": ("upper_arm", "hand"),
    "hand": ("forearm", FREE),
    "thigh": ("pelvis", "shin"),
    "shin": ("thigh", "foot"),
    "foot": ("shin", FREE),
}
"""By kind of segment: the part before its start, and the one after its end."""


@dataclass(frozen=True, eq=False)
class LimbAxes:
    """Points on the axes of O parts of a body."""

    parts: PieceStack
    camera: Camera

    @property
    def beyond(self) -> IndexArray:
        """(O, 2) index of the part before each part's start and after its end, FREE or UNKNOWN."""
        names = self.parts.segments
        rows = []
        for name in names:
            kind, _, side = name.partition(".")
            row = []
            for other in BEYOND[kind]:
                if isinstance(other, str):
                    sided = f"{other}.{side}"
                    other = names.index(sided if sided in names else other)
                row.append(other)
            rows.append(row)
        return np.array(rows, dtype=np.intp)

    def points(self, pose: Pose, frame: IndexArray, share: Array) -> tuple[Array, Array]:
        """Points at shares (F, O) of the parts' lengths: (F, O, 3) [m], and (F, O, 2) in the image [px]."""
        start, end = (self.parts.place(pose, at) for at in (self.parts.start, self.parts.end))
        world = start + share[..., None] * (end - start)
        return world, self.camera.project(world, frame[:, None])[0]

    def jacobian(self, pose: Pose, frame: IndexArray, world: Array, direction: Array) -> Array:
        """(F, O, D) d (direction · pixel) / d tangent of points (F, O, 3) [px per m or rad].

        Args:
            pose: Forward kinematics of F postures.
            frame: (F,) their indices in the clip.
            world: (F, O, 3) the points [m].
            direction: (F, O, 2) unit directions in the image.
        """
        slope = self.camera.project_jacobian(world, frame[:, None])
        force = (direction[..., None, :] @ slope)[..., 0, :]
        return pose.along_jacobian(self.parts.joint, world, force)
