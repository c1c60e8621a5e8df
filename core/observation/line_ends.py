"""g(θ) as the paper has it: the characteristics of a marker from both projected ends of its segment.

The paper (section 3.2) says only that the characteristics of a marker area are expressed with the image
coordinates of both ends of the body part. Here the centroid is their midpoint, the direction that of the
line between them, and the aspect ratio compares the line's length with the segment's given width.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..body.kinematics import Body, Pose
from ..errors import InputError
from ..footage.camera import Camera
from ..footage.moments import axis_angle_difference, characteristics
from ..footage.tracks import RegionTracks

Array = NDArray[np.float64]

X, Y, ANGLE, LOG_RATIO = range(4)
"""Columns of the characteristics: S_x, S_y [px], S_θ [rad, modulo π], log S_λ."""

WIDTHS_OF_STATURE: Mapping[str, float] = MappingProxyType(
    {
        "trunk": 0.17,
        "pelvis": 0.18,
        "chest": 0.17,
        "head": 0.09,
        "girdle": 0.09,
        "upper_arm": 0.055,
        "forearm": 0.045,
        "hand": 0.05,
        "thigh": 0.085,
        "shin": 0.06,
        "foot": 0.055,
    }
)
"""Width of each kind of segment as seen from the front, in statures; rough, as clothes make it anyway."""

Place = tuple[int, Array]
"""A joint and a place in its frame, (3,) [m]."""


@dataclass(frozen=True, eq=False)
class LineEnds:
    """The paper's observation of M marked segments.

    Raises:
        InputError: A segment is unknown.
    """

    body: Body
    camera: Camera
    segments: tuple[str, ...]
    """Segment of each marker: one of the skeleton's, or `trunk` (hips' midpoint to shoulders' midpoint)."""

    def __post_init__(self) -> None:
        """Look the segments up, so that an unknown one is told at once."""
        _ = self._ends

    @cached_property
    def _ends(self) -> tuple[tuple[list[Place], list[Place]], ...]:
        """For each segment the places whose mean is its start, and those whose mean is its end."""
        return tuple(_segment_ends(self.body, name) for name in self.segments)

    @cached_property
    def width_m(self) -> Array:
        """(M,) width of each marked segment [m]."""
        stature = self.body.actor.stature_m
        return np.array([WIDTHS_OF_STATURE[name.split(".")[0]] * stature for name in self.segments])

    def evaluate(self, pose: Pose, frame: ArrayLike | None = None) -> Array:
        """The characteristics that the pose lets expect (paper, eq. 7 without noise).

        A line of length l and width w [px] is taken for a region with S_λ = 1 + (l / w)²: the square of a
        rectangle's sides (eq. 6 is the square of Figure 4's a/b) when seen from the side, and 1, a round
        region, when seen end on.

        Args:
            pose: the body's pose, of any batch shape.
            frame: index of each pose's camera, integers of the batch shape; a fixed camera ignores it.

        Returns:
            (..., M, 4) in the order X, Y, ANGLE, LOG_RATIO; NaN for a segment not in front of the camera.
        """
        pixels, depth = self.camera.project(self._world_ends(pose), _per_end(frame))  # (..., M, 2, 2)
        line = pixels[..., 1, :] - pixels[..., 0, :]
        squared = _squared_shape(line, self._width_px(depth))
        centre = pixels.mean(axis=-2)
        angle = np.arctan2(line[..., 1], line[..., 0])
        return np.stack([centre[..., 0], centre[..., 1], angle, np.log1p(squared)], axis=-1)

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
        centre = image.mean(axis=-3)
        return np.stack([centre[..., 0, :], centre[..., 1, :], d_angle, d_log_ratio], axis=-2)

    def width_px(self, pose: Pose, frame: ArrayLike | None = None) -> Array:
        """Width of each marked segment in the image, (..., M) [px]; arguments as `evaluate`."""
        return self._width_px(self.camera.depth(self._world_ends(pose), _per_end(frame)))

    def _width_px(self, depth: Array) -> Array:
        return np.asarray(self.width_m * self.camera.focal_px / depth.mean(axis=-1))

    def _world_ends(self, pose: Pose) -> Array:
        """Both ends of each segment in the world, (..., M, 2, 3) [m]."""
        rows = [
            np.stack([np.mean([pose.place(*place) for place in end], axis=0) for end in pair], axis=-2)
            for pair in self._ends
        ]
        return np.stack(rows, axis=-3)

    def _world_ends_jacobian(self, pose: Pose) -> Array:
        """Derivative of the ends, (..., M, 2, 3, D)."""
        rows = []
        for pair in self._ends:
            ends = [
                np.mean([pose.place_jacobian(joint, pose.place(joint, at)) for joint, at in end], axis=0)
                for end in pair
            ]
            rows.append(np.stack(ends, axis=-3))
        return np.stack(rows, axis=-4)


def observed_characteristics(tracks: RegionTracks) -> Array:
    """The characteristics of tracked regions (paper, eqs. 3 to 6), (F, M, 4) in the order of `evaluate`.

    NaN where a marker is hidden, or where its region is too thin to have a ratio.
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
    """How far a region of aspect S_λ has a direction: (S_λ - 1)/(S_λ + 1), from 0 (round) to 1 (a line).

    The direction is half the angle of (A_xx - A_yy, 2 A_xy), whose length is λ1 - λ2; an error of A in
    proportion to its size λ1 + λ2 therefore turns it by the inverse of this weight.
    """
    return np.asarray(np.tanh(0.5 * np.maximum(np.asarray(log_ratio, dtype=np.float64), 0.0)))


def _squared_shape(line: Array, width_px: Array) -> Array:
    return np.asarray(np.sum(line**2, axis=-1) / width_px**2)


def _per_end(frame: ArrayLike | None) -> NDArray[np.intp] | None:
    return None if frame is None else np.asarray(frame, dtype=np.intp)[..., None, None]


def _segment_ends(body: Body, name: str) -> tuple[list[Place], list[Place]]:
    skeleton = body.skeleton
    if name == "trunk":
        return _points_named(body, ("hip.L", "hip.R")), _points_named(body, ("shoulder.L", "shoulder.R"))
    for segment in skeleton.segments:
        if segment.name == name:
            return [(segment.joint, body.local(segment.start))], [(segment.joint, body.local(segment.end))]
    known = ", ".join(["trunk", *(segment.name for segment in skeleton.segments)])
    raise InputError(f"a marker is bound to the unknown segment '{name}'; known are {known}")


def _points_named(body: Body, names: Sequence[str]) -> list[Place]:
    indices = [body.skeleton.point_names.index(name) for name in names]
    return [(body.skeleton.points[i].joint, body.point_places[i]) for i in indices]
