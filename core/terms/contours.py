"""Predicted contour lines of limbs and trunk in the image, marked or bare, with Jacobians.

Samples lie on the two contour lines of each part's tapered cylinder, where its surface turns away from the
camera. An image edge measures a sample's distance along the contour's normal; motion along the contour is
unobservable (Harris & Stennett 1990, *RAPID, a video rate object tracker*).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, BoolArray, IndexArray
from ..body.body_volume import PieceStack, body_pieces
from ..body.kinematics import Body, Pose
from ..camera.camera import Camera
from .occlusion import PartOutlines, View, part_outlines, view_pieces
from .term import ClipState, Rows, Term

SHARES = (0.2, 0.4, 0.6, 0.8)  # of the samples along a part, whose ends overlap with other parts
SIDES = (-1.0, 1.0)
SHAPE = 4  # corrections of a part [m]: thickness at both ends, lateral and sagittal displacement


@dataclass(frozen=True, eq=False)
class ContourPrediction:
    """N contour samples in F frames."""

    world: Array  # (F, N, 3) [m]
    pixel: Array  # (F, N, 2) [px]
    depth: Array  # (F, N) camera depth [m]
    normal: Array  # (F, N, 2) unit outward normal in the image
    slope: Array  # (F, N, 2, 3) d pixel / d world [px per m]
    half_width: Array  # (F, N) half-width of the part at the sample [px]
    shape_rate: Array  # (F, N, SHAPE) motion of a sample along the normal by each correction [px per m]


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
        """(N, O) whether a part is the sample's own or joined to it."""
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
        """The image outlines of all parts."""
        return part_outlines(self.parts, pose, self.camera, frame)

    def evaluate(self, pose: Pose, frame: IndexArray) -> ContourPrediction:
        """Predict all samples in F frames; `frame` (F,) are their indices in the clip."""
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
        # A shape correction moves a sample along `out` or along the part's own two directions.
        touch = (widths[:, 0] + share[:, None] * (widths[:, 1] - widths[:, 0])) * stretched / half[..., None]
        shape = self.shape[part]
        touch = touch + shape[:, 2:]
        world = center + touch[..., :1] * lateral + touch[..., 1:] * sagittal
        world = world + np.sum(_taper(share) * shape[:, :2], axis=-1)[:, None] * out
        pixel, depth = self.camera.project(world, frame[:, None])
        slope = self.camera.project_jacobian(world, frame[:, None])
        normal = (slope @ out[..., None])[..., 0]
        normal = normal / np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-9)
        scale = self.camera.pixels_per_meter(depth)
        return ContourPrediction(world, pixel, depth, normal, slope, half * scale, rate * scale[..., None])

    def normal_jacobian(self, predicted: ContourPrediction, normal: Array, pose: Pose) -> Array:
        """(F, N, D) d (normal · pixel) / d tangent for given normals (F, N, 2) [px per m or rad]."""
        force = (normal[..., None, :] @ predicted.slope)[..., 0, :]
        return pose.along_jacobian(self.parts.joint[self.part_of], predicted.world, force)


def _taper(share: Array) -> Array:
    """(N, 2) weights of a part's two ends at shares (N,) of its length."""
    return np.stack([1.0 - share, share], axis=-1)


def _between(view: View, part: IndexArray, share: Array) -> Array:
    return np.asarray(view.start[:, part] + share[:, None] * (view.end - view.start)[:, part])


SUBPIXEL_BITS = 4  # fractional bits of the coordinates that outlines are drawn with

_TURN = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
CIRCLE = np.stack([np.cos(_TURN), np.sin(_TURN)])


def part_map(parts: PartOutlines, frame: int, size: tuple[int, int], factor: float) -> NDArray[np.int8]:
    """Draw the body of one frame, the farthest part first.

    (rows, columns) index of the visible part, -1 for none; `size`: columns and rows; `factor`: pixels of the
    camera to one of the map.
    """
    labels = np.full((size[1], size[0]), 255, dtype=np.uint8)
    outlines = _outlines(parts, frame) / factor - 0.5
    whole = np.isfinite(outlines).all(axis=(1, 2))
    corners = np.round(np.where(whole[:, None, None], outlines, 0.0) * 2**SUBPIXEL_BITS).astype(np.int32)
    for part in np.argsort(-parts.depth[frame].mean(-1)):
        if whole[part]:
            hull = cv2.convexHull(corners[part])
            cv2.fillConvexPoly(labels, hull, (int(part),), cv2.LINE_8, SUBPIXEL_BITS)
    return labels.view(np.int8)


def _outlines(parts: PartOutlines, frame: int) -> Array:
    """(O, corners, 2) corners of the elliptical ends of all parts; a part's outline is their hull [px]."""
    ends = np.stack([parts.start[frame], parts.end[frame]], axis=1)  # (O, 2, 2)
    along = ends[:, 1] - ends[:, 0]
    along = along / np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-6)
    across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    out = (parts.half_width[frame][..., None, None] * CIRCLE[0, :, None]) * across[:, None, None]
    past = (parts.overshoot[frame][..., None, None] * CIRCLE[1, :, None]) * along[:, None, None]
    return np.asarray((ends[:, :, None] + out + past).reshape(len(ends), -1, 2))


FREE, UNKNOWN = -1, -2  # what lies beyond a part's end: the background, or any of several things
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
}  # by kind of segment: the part before its start, and the one after its end


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
        """(F, O, D) d (direction · pixel) / d tangent of points (F, O, 3) [px per m or rad]."""
        slope = self.camera.project_jacobian(world, frame[:, None])
        force = (direction[..., None, :] @ slope)[..., 0, :]
        return pose.along_jacobian(self.parts.joint, world, force)


# --- The terms


SURFACE_SHARE = 0.2  # standard deviation of a part's contour as a whole, of its half-width: clothes, muscles
PIXEL_STD = 0.6  # the same in pixels of the pictures: blur and light
ALIKE = len(SHARES) * len(SIDES)  # the samples of a part err together: all of them weigh as much as one


@dataclass(frozen=True, eq=False)
class ContourTerm(Term):
    """Compares every contour sample with the edge found near it."""

    model: ContourModel
    edge: Array  # (F, N, 2) where the edge lies [px]; NaN where none was found
    normal: Array  # (F, N, 2) across it
    variance: Array  # (F, N) [px²]
    is_image: ClassVar[bool] = True
    counts: ClassVar[float] = 1.0 / ALIKE

    def parts_seen(self) -> BoolArray:
        """(F, O) whether enough edges of each part were found."""
        found = np.isfinite(self.edge[..., 0])
        return np.asarray(found.reshape(len(found), -1, ALIKE).sum(axis=-1) >= 3)

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """A row for each edge."""
        predicted = self.model.evaluate(state.pose, state.frame)
        std = np.sqrt(self.variance + (SURFACE_SHARE * predicted.half_width) ** 2)[..., None]
        error = np.sum(self.normal * (predicted.pixel - self.edge), axis=-1, keepdims=True) / std
        by = None
        if slopes:
            by = (self.model.normal_jacobian(predicted, self.normal, state.pose) / std)[:, :, None]
        yield Rows(error, by, np.isfinite(error[..., 0]))


@dataclass(frozen=True, eq=False)
class AxialTerm(Term):
    """Compares where parts are along their axes with where their colors are seen."""

    axes: LimbAxes
    share: Array  # (F, O) the point of each part's length that the colors say most of
    place: Array  # (F, O) where it is seen, along the direction [px]; NaN where nothing was found
    direction: Array  # (F, O, 2) unit direction of the axis
    variance: Array  # (F, O) [px²]
    lasting: Array
    is_image: ClassVar[bool] = True

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """A row for each part."""
        world, pixel = self.axes.points(state.pose, state.frame, self.share)
        std = np.sqrt(self.variance)[..., None]
        error = (np.sum(self.direction * pixel, axis=-1) - self.place)[..., None] / std
        by = None
        if slopes:
            by = (self.axes.jacobian(state.pose, state.frame, world, self.direction) / std)[:, :, None]
        yield Rows(error, by, np.isfinite(error[..., 0]))
