"""Where the sides of limbs and trunk appear in the image, marked or bare, with Jacobians.

Samples lie on the two contour lines of each part's tapered cylinder, where its surface turns away from the
camera. What an edge in the image can say of a sample is its distance along the contour's normal; what moves
along the contour cannot be seen (Harris & Stennett 1990, *RAPID, a video rate object tracker*).
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.body_volume import PieceStack, body_pieces
from ..body.kinematics import Body, Pose
from ..body.rotations import cross
from ..footage.camera import Camera
from .occlusion import PartOutlines, part_outlines
from .silhouette import View, view_pieces

SHARES = (0.2, 0.4, 0.6, 0.8)
"""Where on a part samples lie; its ends are another part's as much."""
SIDES = (-1.0, 1.0)
SHAPE = 4
"""Numbers that correct a part's shape: thickness at both ends, place along lateral and sagittal [m]."""


@dataclass(frozen=True, eq=False)
class ContourPrediction:
    """N contour samples in F frames."""

    world: Array
    """(F, N, 3) [m]."""
    pixel: Array
    """(F, N, 2) [px]."""
    depth: Array
    """(F, N) from the camera [m]."""
    normal: Array
    """(F, N, 2) unit vector out of the part, in the image."""
    slope: Array
    """(F, N, 2, 3) d pixel / d world [px per m]."""
    half_width: Array
    """(F, N) of the part there [px]."""
    shape_rate: Array
    """(F, N, SHAPE) how far [px] along the normal a meter of each correction moves a sample."""


@dataclass(frozen=True, eq=False)
class ContourModel:
    """Predicts the contours of an actor's parts; `shape` (O, SHAPE) corrects the average body [m]."""

    body: Body
    camera: Camera
    shape: Array

    @classmethod
    def average(cls, body: Body, camera: Camera) -> "ContourModel":
        """The contours of the average body."""
        return cls(body, camera, np.zeros((len(body_pieces(body)), SHAPE)))

    def with_shape(self, shape: Array) -> "ContourModel":
        """The same with other corrections."""
        return replace(self, shape=shape)

    @cached_property
    def parts(self) -> PieceStack:
        """All parts of the body, O of them."""
        return PieceStack.of(body_pieces(self.body))

    @cached_property
    def part_of(self) -> IndexArray:
        """(N,) the part of each sample."""
        return np.repeat(np.arange(len(self.parts.segments)), len(SHARES) * len(SIDES))

    @cached_property
    def adjoining(self) -> BoolArray:
        """(N, O) the part itself and those it is joined to."""
        joined = np.eye(len(self.parts.segments), dtype=bool)
        segments = {segment.name: segment for segment in self.body.skeleton.segments}
        names = self.parts.segments
        for child, name in enumerate(names):
            above = segments[name].parent
            while above is not None and above not in names:
                above = segments[above].parent
            if above is not None:
                joined[child, names.index(above)] = joined[names.index(above), child] = True
        return joined[self.part_of]

    def part_outlines(self, pose: Pose, frame: IndexArray) -> PartOutlines:
        """The outlines of all parts."""
        return part_outlines(self.parts, pose, self.camera, frame)

    def evaluate(self, pose: Pose, frame: IndexArray) -> ContourPrediction:
        """Predict all samples in F frames; `frame` (F,) are their places in the clip."""
        view = view_pieces(self.parts, pose, self.camera, frame)
        part = self.part_of
        repeats = len(part) // (len(SHARES) * len(SIDES))
        share = np.tile(np.repeat(SHARES, len(SIDES)), repeats)
        side = np.tile(SIDES, repeats * len(SHARES))
        out = side[:, None] * view.across[:, part]  # (F, N, 3)
        lateral, sagittal = view.lateral[:, part], view.sagittal[:, part]
        cosines = np.stack([np.sum(out * lateral, -1), np.sum(out * sagittal, -1)], axis=-1)
        widths = self.parts.half_widths[part]
        stretched = (widths[:, 0] + share[:, None] * (widths[:, 1] - widths[:, 0])) * cosines
        half = np.maximum(np.sqrt(np.sum(stretched**2, axis=-1)), 1e-6)
        rate = np.concatenate([np.broadcast_to(_taper(share), (*half.shape, 2)), cosines], axis=-1)
        center = _between(view, part, share)
        # Correcting the shape moves a sample along `out` or along the part's own two directions.
        touch = (widths[:, 0] + share[:, None] * (widths[:, 1] - widths[:, 0])) * stretched / half[..., None]
        shape = self.shape[part]
        touch = touch + shape[:, 2:]
        world = center + touch[..., :1] * lateral + touch[..., 1:] * sagittal
        world = world + np.sum(_taper(share) * shape[:, :2], axis=-1)[:, None] * out
        pixel, depth = self.camera.project(world, frame[:, None])
        slope = self.camera.project_jacobian(world, frame[:, None])
        normal = (slope @ out[..., None])[..., 0]
        normal = normal / np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-9)
        scale = self.camera.focal_px / np.maximum(depth, 0.1)
        return ContourPrediction(world, pixel, depth, normal, slope, half * scale, rate * scale[..., None])

    def normal_jacobian(self, predicted: ContourPrediction, normal: Array, pose: Pose) -> Array:
        """(F, N, D) how far samples move along given normals (F, N, 2) by the posture's tangent [px]."""
        force = (normal[..., None, :] @ predicted.slope)[..., 0, :]
        wrench = np.concatenate([force, cross(predicted.world, force)], axis=-1)
        moved = pose.posture.skeleton.moved_by[self.parts.joint[self.part_of]]
        return np.asarray((wrench @ pose.screws) * moved)


def _taper(share: Array) -> Array:
    """(N, 2) weights of a part's two ends at shares (N,) of its length."""
    return np.stack([1.0 - share, share], axis=-1)


def _between(view: View, part: IndexArray, share: Array) -> Array:
    """(F, N, 3) places on the parts' axes."""
    return np.asarray(view.start[:, part] + share[:, None] * (view.end - view.start)[:, part])
