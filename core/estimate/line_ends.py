"""g(θ), the paper's measurement model: a marker's characteristics from both projected ends of its segment.

The paper (section 3.2) says only that the characteristics of a marker area are expressed with the image
coordinates of both ends of the body part. Here the centroid is their midpoint, the direction that of the
line between them, and the aspect ratio compares the line's length with the segment's given width.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, IndexArray
from ..body.body_volume import TRUNK, marker_parts, segment_piece
from ..body.kinematics import Body, Pose
from ..body.skeleton import SIDES
from ..camera.camera import Camera
from ..markers.moments import axis_angle_difference, characteristics
from ..markers.region_tracks import RegionTracks

X, Y, ANGLE, LOG_RATIO = range(4)  # columns: S_x, S_y [px], S_θ [rad, modulo π], log S_λ

JointPoint = tuple[int, Array]  # a joint and a point in its frame, (3,) [m]


@dataclass(frozen=True, eq=False)
class LineEnds:
    """The paper's measurement model of M marked segments."""

    body: Body
    camera: Camera
    segments: tuple[str, ...]  # the skeleton's, or `trunk` (from hips' to shoulders' midpoint)

    @cached_property
    def width_m(self) -> Array:
        """(M,) width of each marked segment from the front [m]: the mean of its parts' ends."""
        pieces = [[segment_piece(self.body, part) for part in marker_parts(name)] for name in self.segments]
        return np.array([2.0 * np.mean([piece.half_widths[:, 0] for piece in parts]) for parts in pieces])

    @cached_property
    def _end_points(self) -> tuple[IndexArray, Array, Array]:
        """Joints (A,) and local points (A, 3) that the ends are means of, and their weights (M, 2, A)."""
        ends = [end for name in self.segments for end in _segment_ends(self.body, name)]
        owner = np.repeat(np.arange(len(ends)), [len(end) for end in ends])
        share = np.eye(len(ends))[:, owner] / np.bincount(owner)[:, None]
        joint, local = zip(*(point for end in ends for point in end), strict=True)
        return np.array(joint, dtype=np.intp), np.stack(local), share.reshape(-1, 2, len(owner))

    def evaluate(self, pose: Pose, frame: ArrayLike | None = None) -> Array:
        """Predicted characteristics (paper, eq. 7 without noise).

        A line of length l and width w [px] counts as a region with S_λ = 1 + (l / w)²: the squared ratio of a
        rectangle's sides (eq. 6 is the square of Figure 4's a/b) when seen from the side, and 1, a round
        region, when seen end on.

        (..., M, 4) in the order X, Y, ANGLE, LOG_RATIO, of poses of any batch shape; NaN for a segment not in
        front of the camera.
        """
        pixels, depth = self.camera.project(self._world_ends(pose), _per_end(frame))  # (..., M, 2, 2)
        line = pixels[..., 1, :] - pixels[..., 0, :]
        squared = _squared_shape(line, self._width_px(depth))
        center = pixels.mean(axis=-2)
        angle = np.arctan2(line[..., 1], line[..., 0])
        return np.stack([center[..., 0], center[..., 1], angle, np.log1p(squared)], axis=-1)

    def jacobian(self, pose: Pose, frame: ArrayLike | None = None) -> Array:
        """Derivative of `evaluate` by the posture's tangent step, (..., M, 4, D); arguments as there.

        The row of the angle grows without bound as a line shrinks to a point; `angle_weight` falls faster.
        """
        world, ends_jacobian, end = self._world_ends(pose), self._world_ends_jacobian(pose), _per_end(frame)
        pixels, depth = self.camera.project(world, end)
        image = self.camera.project_jacobian(world, end) @ ends_jacobian  # (..., M, 2, 2, D)
        farther = (self.camera.depth_jacobian(world, end)[..., None, :] @ ends_jacobian)[..., 0, :]
        line, d_line = pixels[..., 1, :] - pixels[..., 0, :], image[..., 1, :, :] - image[..., 0, :, :]
        length_squared = np.maximum(np.sum(line**2, axis=-1), 1e-12)[..., None]
        turned = np.stack([-line[..., 1], line[..., 0]], axis=-1)
        d_angle = np.einsum("...i,...id->...d", turned, d_line) / length_squared
        squared = _squared_shape(line, self._width_px(depth))[..., None]
        d_depth = farther.mean(axis=-2) / depth.mean(axis=-1)[..., None]
        d_length = np.einsum("...i,...id->...d", line, d_line) / length_squared
        d_log_ratio = 2.0 * squared / (1.0 + squared) * (d_length + d_depth)
        center = image.mean(axis=-3)
        return np.stack([center[..., 0, :], center[..., 1, :], d_angle, d_log_ratio], axis=-2)

    def width_px(self, pose: Pose, frame: ArrayLike | None = None) -> Array:
        """Width of each marked segment in the image, (..., M) [px]; arguments as `evaluate`."""
        return self._width_px(self.camera.depth(self._world_ends(pose), _per_end(frame)))

    def _width_px(self, depth: Array) -> Array:
        return np.asarray(self.width_m * self.camera.focal_px / depth.mean(axis=-1))

    def _world_ends(self, pose: Pose) -> Array:
        """Both ends of each segment in the world, (..., M, 2, 3) [m]."""
        return np.asarray(np.einsum("mea,...ai->...mei", self._end_points[2], self._world_points(pose)))

    def _world_points(self, pose: Pose) -> Array:
        joint, local, _ = self._end_points
        turned = (pose.rotation[..., joint, :, :] @ local[..., None])[..., 0]
        return np.asarray(pose.origin[..., joint, :] + turned)

    def _world_ends_jacobian(self, pose: Pose) -> Array:
        """Derivative of the ends, (..., M, 2, 3, D)."""
        joint, _, share = self._end_points
        moving = pose.places_jacobian(joint, self._world_points(pose))
        return np.asarray(np.einsum("mea,...aid->...meid", share, moving))


def observed_characteristics(tracks: RegionTracks) -> Array:
    """Measured characteristics of tracked regions (paper, eqs. 3 to 6), (F, M, 4) in the order of `evaluate`.

    NaN where a marker is hidden, or where its region is too thin for a ratio.
    """
    seen = characteristics(tracks.centroid, tracks.second_moment)
    with np.errstate(divide="ignore", invalid="ignore"):
        log_ratio = np.log(seen.ratio)
    return np.stack([seen.x, seen.y, seen.angle_rad, log_ratio], axis=-1)


def residual(observed: Array, predicted: Array) -> Array:
    """Innovation observed - predicted of characteristics (..., 4), the angle wrapped to [-π/2, π/2)."""
    difference = observed - predicted
    difference[..., ANGLE] = axis_angle_difference(observed[..., ANGLE], predicted[..., ANGLE])
    return np.asarray(difference)


def angle_weight(log_ratio: ArrayLike) -> Array:
    """Weight of the direction of a region of aspect S_λ: (S_λ - 1)/(S_λ + 1), from 0 (round) to 1 (a line).

    The direction is half the angle of (A_xx - A_yy, 2 A_xy), whose length is λ1 - λ2; an error of A in
    proportion to its size λ1 + λ2 therefore turns it by the inverse of this weight.
    """
    return np.asarray(np.tanh(0.5 * np.maximum(np.asarray(log_ratio, dtype=np.float64), 0.0)))


def _squared_shape(line: Array, width_px: Array) -> Array:
    return np.asarray(np.sum(line**2, axis=-1) / width_px**2)


def _per_end(frame: ArrayLike | None) -> IndexArray | None:
    return None if frame is None else np.asarray(frame, dtype=np.intp)[..., None, None]


def _segment_ends(body: Body, name: str) -> tuple[list[JointPoint], list[JointPoint]]:
    """Points whose mean is the segment's start, and points whose mean is its end."""
    if name != TRUNK:
        segment = body.skeleton.segment(name)
        return [(segment.joint, body.local(segment.start))], [(segment.joint, body.local(segment.end))]
    joints = [point.joint for point in body.skeleton.points]
    known = dict(zip(body.skeleton.point_names, zip(joints, body.point_places, strict=True), strict=True))
    hips, shoulders = ([known[f"{root}.{side}"] for side in SIDES] for root in ("hip", "shoulder"))
    return hips, shoulders
