"""Likelihood of one frame's regions and keypoints, in a form that is linear in a posture's features.

A marker's centroid or a keypoint at r from the hips is seen at the normalized image coordinates (x, y) where
(a + x k) (T + r) = 0 and (b + y k) (T + r) = 0, with T the hips relative to the camera, a and b the camera's
axes to the right and up and k its backward axis in the world. Weighted least squares gives T and the
residuals as fixed matrices of a frame times a posture's features: every posture and heading in one product. A
guess d of a point's depth behind the hips, along the line of sight e, is linear as well: e r = d.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..footage.camera import Camera
from .match_evidence import LEAST_QUALITY, MatchEvidence
from .noise_scales import NoiseScales
from .posed_constraints import HIPS_STD_M, PosedConstraints

EXTENT_STD_M = 0.025
"""Deviation of a marker's extent: clothes, the color's ends, a limb turned by a few degrees."""
DOWNWEIGHT = 0.15
"""Share of its weight that a downweighted marker keeps in solving for the hips, since another performer may
hold that limb otherwise; of all solutions the likeliest counts."""
WEAK_STD_M = 1e3
"""Prior of the hips' place, for frames that determine too little of it; of no weight beside any marker."""


@dataclass(frozen=True, eq=False)
class FrameLikelihood:
    """One frame: linear maps from a posture's features to the hips' place and to the residuals.

    A posture's features are the places of A points, M of them markers (3 A), the hips' height above the
    floor, and 1. The maps have V variants: all rows trusted, then each visible group of points downweighted,
    then the floor. G is the number of guessed depths: one a keypoint, or none.
    """

    hips_map: Array
    """(V, 3, 3 A + 2) to the hips' place in the world [m]."""
    residual_map: Array
    """(V, 2 A + G + 4, 3 A + 2) to the residuals in standard deviations: two of each point, one of each
    guessed depth, three of the hips where they are posed, one of the floor."""
    weight: Array
    """(A,) one over the standard deviation of each point's place [1/m]; 0 where it is not visible."""
    information: Array
    """(3, 3) inverse covariance of the hips' place [1/m²]."""
    backward: Array
    """(3,) the camera's backward axis in the world."""
    location: Array
    """(3,) the camera's place [m]."""
    image_axes: Array
    """(A, 2, 3) directions in the world along which a marker's image extends to the right and upwards."""
    extent: Array
    """(M, 3) square root of the observed second moments per meter of depth, xx, xy, yy, at average size."""
    extent_std_m: Array
    """(M,) standard deviation of their difference from the predicted ones."""
    sight: Array
    """(3,) line of sight to the performer, along which depths are guessed."""
    depth_m: Array
    """(G,) guessed depth of each keypoint behind the hips [m]; 0 where there is none."""
    depth_weight: Array
    """(G,) one over its standard deviation [1/m]; 0 where there is none."""
    normalization: float
    """Added to costs: logarithm of the scales' determinant, so that different noise scales can be
    compared."""
    pixel_size: float
    """Size of a pixel per meter of depth."""
    visible: BoolArray
    """(A,) points found in the frame."""
    unclipped: BoolArray
    """(M,) markers found whose region is not cut off by the picture's edge."""
    stretch: Array
    """(A, 2) how the points' rows err together where keypoints have the performer larger or smaller; see
    `unstretched`."""
    share: float
    """Weight of each point's cost, since they do not differ independently."""


def frame_likelihoods(
    camera: Camera,
    evidence: MatchEvidence,
    frames: IndexArray,
    floor_m: float | None,
    floor_std_m: float,
    noise_scales: NoiseScales | None = None,
    constraints: PosedConstraints | None = None,
) -> list[FrameLikelihood]:
    """Likelihoods of some frames.

    Args:
        camera: The camera.
        evidence: The markers' regions and the keypoints.
        frames: Which frames.
        floor_m: Height of the floor; None where it is not known.
        floor_std_m: Standard deviation of a posture's height above it.
        noise_scales: The performer's; unit scales by default.
        constraints: Posed keyframes.
    """
    scales = noise_scales or NoiseScales.of(evidence)
    posed = [None if constraints is None else constraints.hips_at(int(frame)) for frame in frames]
    return [
        _frame_likelihood(camera, evidence, int(frame), floor_m, floor_std_m, scales, hips)
        for frame, hips in zip(frames, posed, strict=True)
    ]


def _frame_likelihood(
    camera: Camera,
    evidence: MatchEvidence,
    frame: int,
    floor_m: float | None,
    floor_std_m: float,
    noise_scales: NoiseScales,
    hips: Array | None,
) -> FrameLikelihood:
    tracks, quality = evidence.tracks, evidence.quality[frame]
    visible = evidence.visible[frame]
    rotation, location = camera.pose(frame)
    right, up, backward = rotation.T
    pixels = np.where(visible[:, None], evidence.pixel[frame], camera.principal_point)
    _, ray = camera.rays(pixels, frame)
    away = -ray @ backward
    x, y = ray @ right / away, ray @ up / away
    lost = ~np.isfinite(x + y)
    visible, x, y = visible & ~lost, np.where(lost, 0.0, x), np.where(lost, 0.0, y)
    image_axes = np.stack([right + x[:, None] * backward, up + y[:, None] * backward], axis=1)  # (A, 2, 3)
    deviation = noise_scales.centroid * evidence.deviation_m
    weight = np.where(visible, np.sqrt(np.clip(quality, LEAST_QUALITY, 1.0)) / deviation, 0.0)
    sight = _line_of_sight(ray[visible], backward)
    depth_m, depth_weight = _guessed_depths(evidence, frame, visible, noise_scales)
    rows = _Rows.of_points(weight, image_axes, len(depth_m))
    stretch = _stretch(weight[:, None] * evidence.size_error_m[frame])
    rows.disregard(stretch)
    rows.add_depths(len(weight), evidence.marker_count, sight, depth_m, depth_weight)
    rows.add_place(location, floor_m, floor_std_m, hips)
    by_hips, by_posture = rows.by_hips, rows.by_posture
    variants: list[IndexArray] = [np.zeros(0, dtype=np.intp), *_visible_groups(evidence, visible)]
    if floor_m is not None:
        variants.append(np.array([len(by_hips) - 1]))  # for jumps higher than the library's
    hips_map = np.stack([_hips_map(by_hips, by_posture, each) for each in variants])
    residual_map = by_posture + by_hips @ hips_map
    hips_map[:, :, -1] += location
    pixel_size = 1.0 / camera.focal_px
    moments = tracks.second_moment[frame] * pixel_size**2
    unclipped = visible[: evidence.marker_count] & ~tracks.clipped[frame]
    # Image rows run down, the camera's axis up.
    extent = square_root(moments[:, 0, 0], -moments[:, 0, 1], moments[:, 1, 1])
    return FrameLikelihood(
        hips_map,
        residual_map,
        weight,
        by_hips.T @ by_hips + np.eye(3) / WEAK_STD_M**2,
        backward,
        location,
        image_axes,
        np.where(unclipped[:, None], np.stack(extent, axis=-1), 0.0) / noise_scales.size[:, None],
        EXTENT_STD_M * noise_scales.extent,
        sight,
        depth_m,
        depth_weight,
        float(
            2.0 * evidence.share * np.log(noise_scales.centroid[visible]).sum()
            + 3.0 * np.log(noise_scales.extent[unclipped]).sum()
            + evidence.share * np.log(noise_scales.depth[: len(depth_m)][depth_weight > 0.0]).sum()
        ),
        pixel_size,
        visible,
        unclipped,
        stretch,
        evidence.share,
    )


def _stretch(shift: Array) -> Array:
    """`FrameLikelihood.stretch` of displacements (A, 2) in standard deviations.

    With rows r of unit covariance and u their displacement by an error of the size, (1 + u uᵀ)^-½ r =
    r - s sᵀ r are rows in which that error counts as noise.
    """
    squared = float((shift**2).sum())
    if squared == 0.0:
        return shift
    return np.asarray(shift * np.sqrt((1.0 - 1.0 / np.sqrt(1.0 + squared)) / squared))


def unstretched(rows: Array, stretch: Array) -> Array:
    """Rows (..., A, 2) with an error of the size in `stretch` (..., A, 2) counted as noise."""
    if not stretch.any():
        return rows
    along = (rows * stretch).sum(axis=(-2, -1), keepdims=True)
    return np.asarray(rows - stretch * along)


def _line_of_sight(ray: Array, backward: Array) -> Array:
    """(3,) unit mean of some rays; straight ahead without any."""
    if not len(ray):
        return -backward
    mean = ray.mean(axis=0)
    return np.asarray(mean / np.linalg.norm(mean))


def _guessed_depths(
    evidence: MatchEvidence, frame: int, visible: BoolArray, noise_scales: NoiseScales
) -> tuple[Array, Array]:
    """(G,) guessed depths behind the hips [m], and one over their standard deviations; G is 0 without any."""
    if not evidence.has_hints:
        return np.zeros(0), np.zeros(0)
    depth = evidence.keypoints.hint_m[frame, :, 2]
    known = np.isfinite(depth) & visible[evidence.marker_count :]
    deviation = evidence.depth_deviation_m * noise_scales.depth
    return np.where(known, depth, 0.0), np.where(known, 1.0 / deviation, 0.0)


def _visible_groups(evidence: MatchEvidence, visible: BoolArray) -> list[IndexArray]:
    """The rows of each group of points of which any is visible."""
    groups = [group[visible[group]] for group in evidence.groups]
    return [np.sort(np.concatenate([2 * group, 2 * group + 1])) for group in groups if len(group)]


@dataclass(frozen=True, eq=False)
class _Rows:
    """Jacobians of the residuals: R = 2 A + G + 4 rows."""

    by_hips: Array
    """(R, 3)."""
    by_posture: Array
    """(R, 3 A + 2) by a posture's features."""

    @classmethod
    def of_points(cls, weight: Array, image_axes: Array, depths: int) -> "_Rows":
        """The points' rows; all others are zero."""
        count = len(weight)
        rows = 2 * count + depths + 4
        by_hips, by_posture = np.zeros((rows, 3)), np.zeros((rows, 3 * count + 2))
        for index in range(count):
            pair = weight[index] * image_axes[index]
            by_hips[2 * index : 2 * index + 2] = pair
            by_posture[2 * index : 2 * index + 2, 3 * index : 3 * index + 3] = pair
        return cls(by_hips, by_posture)

    def disregard(self, stretch: Array) -> None:
        """Take a share of a common error out of the points' rows; see `unstretched`."""
        flat = stretch.ravel()
        if flat.any():
            for matrix in (self.by_hips, self.by_posture):
                matrix[: len(flat)] -= np.outer(flat, flat @ matrix[: len(flat)])

    def add_depths(self, points: int, markers: int, sight: Array, depth_m: Array, weight: Array) -> None:
        """Set the rows of the guessed depths, which the hips' place does not change."""
        for index in range(len(depth_m)):
            row, column = 2 * points + index, 3 * (markers + index)
            self.by_posture[row, column : column + 3] = weight[index] * sight
            self.by_posture[row, -1] = -weight[index] * depth_m[index]

    def add_place(
        self, location: Array, floor_m: float | None, floor_std_m: float, hips: Array | None
    ) -> None:
        """Set the rows of posed hips and of the floor, as far as they are known."""
        if hips is not None:
            self.by_hips[-4:-1] = np.eye(3) / HIPS_STD_M
            self.by_posture[-4:-1, -1] = (location - hips) / HIPS_STD_M
        if floor_m is not None:
            self.by_hips[-1, 2] = 1.0 / floor_std_m
            self.by_posture[-1, -2] = -1.0 / floor_std_m
            self.by_posture[-1, -1] = (location[2] - floor_m) / floor_std_m


def _hips_map(by_hips: Array, by_posture: Array, downweighted: IndexArray) -> Array:
    """(3, 3 A + 2) least-squares solution for the hips, relative to the camera; some rows downweighted."""
    trust = np.ones(len(by_hips))
    trust[downweighted] = DOWNWEIGHT
    weighted = by_hips.T * trust**2
    return np.asarray(-np.linalg.solve(weighted @ by_hips + np.eye(3) / WEAK_STD_M**2, weighted @ by_posture))


def square_root(xx: Array, xy: Array, yy: Array) -> tuple[Array, Array, Array]:
    """Square root of symmetric 2 x 2 matrices, given and returned by entries."""
    root = np.sqrt(np.maximum(xx * yy - xy * xy, 0.0))
    scale = 1.0 / np.sqrt(np.maximum(xx + yy + 2.0 * root, 1e-12))
    return (xx + root) * scale, xy * scale, (yy + root) * scale
