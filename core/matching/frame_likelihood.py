"""Likelihood of one frame's regions, in a form that is linear in a posture's features.

A marker whose centroid lies at r from the hips is seen at the normalized image coordinates (x, y) where (a +
x k) (T + r) = 0 and (b + y k) (T + r) = 0, with T the hips relative to the camera, a and b the camera's axes
to the right and up and k its backward axis in the world. Weighted least squares gives T and the residuals as
fixed matrices of a frame times a posture's features: every posture and heading in one product.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..footage.camera import Camera
from ..footage.region_tracks import RegionTracks
from .noise_scales import NoiseScales
from .posed_constraints import HIPS_STD_M, PosedConstraints

CENTROID_STD_M = {"trunk": 0.05, "pelvis": 0.04, "chest": 0.06, "head": 0.07, "girdle": 0.06}
"""Deviation of a marker between performers at the same moment of a motion, the hips aligned."""
LIMB_STD_M = {"upper_arm": 0.07, "forearm": 0.11, "hand": 0.14, "thigh": 0.05, "shin": 0.09, "foot": 0.12}
EXTENT_STD_M = 0.025
"""Deviation of a marker's extent: clothes, the color's ends, a limb turned by a few degrees."""
LEAST_QUALITY = 0.05
DOWNWEIGHT = 0.15
"""Share of its weight that a downweighted marker keeps in solving for the hips, since another performer may
hold that limb otherwise; of all solutions the likeliest counts."""
WEAK_STD_M = 1e3
"""Prior of the hips' place, for frames that determine too little of it; of no weight beside any marker."""


@dataclass(frozen=True, eq=False)
class FrameLikelihood:
    """One frame: linear maps from a posture's features to the hips' place and to the residuals.

    A posture's features are its markers' centroids (3 M), the hips' height above the floor, and 1. The maps
    have V variants: all rows trusted, then each visible marker downweighted, then the floor.
    """

    hips_map: Array
    """(V, 3, 3 M + 2) to the hips' place in the world [m]."""
    residual_map: Array
    """(V, 2 M + 4, 3 M + 2) to the residuals in standard deviations: two of each marker, three of the hips
    where they are posed, one of the floor."""
    weight: Array
    """(M,) one over the standard deviation of each marker's centroid [1/m]; 0 where it is not visible."""
    information: Array
    """(3, 3) inverse covariance of the hips' place [1/m²]."""
    backward: Array
    """(3,) the camera's backward axis in the world."""
    location: Array
    """(3,) the camera's place [m]."""
    image_axes: Array
    """(M, 2, 3) directions in the world along which a marker's image extends to the right and upwards."""
    extent: Array
    """(M, 3) square root of the observed second moments per meter of depth, xx, xy, yy, at average size."""
    extent_std_m: Array
    """(M,) standard deviation of their difference from the predicted ones."""
    normalization: float
    """Added to costs: logarithm of the scales' determinant, so that different noise scales can be
    compared."""
    pixel_size: float
    """Size of a pixel per meter of depth."""
    visible: BoolArray
    """(M,) markers found in the frame."""
    unclipped: BoolArray
    """(M,) those of them whose region is not cut off by the picture's edge."""


def frame_likelihoods(
    camera: Camera,
    tracks: RegionTracks,
    segments: tuple[str, ...],
    frames: IndexArray,
    floor_m: float | None,
    floor_std_m: float,
    noise_scales: NoiseScales | None = None,
    constraints: PosedConstraints | None = None,
) -> list[FrameLikelihood]:
    """Likelihoods of some frames.

    Args:
        camera: The camera.
        tracks: The markers' regions.
        segments: The segment of each of the M markers.
        frames: Which frames.
        floor_m: Height of the floor; None where it is not known.
        floor_std_m: Standard deviation of a posture's height above it.
        noise_scales: The performer's; unit scales by default.
        constraints: Posed keyframes.
    """
    scales = noise_scales or NoiseScales.unit(len(segments))
    deviation = scales.centroid * [_deviation(segment) for segment in segments]
    posed = [None if constraints is None else constraints.hips_at(int(frame)) for frame in frames]
    return [
        _frame_likelihood(camera, tracks, int(frame), deviation, floor_m, floor_std_m, scales, hips)
        for frame, hips in zip(frames, posed, strict=True)
    ]


def _deviation(segment: str) -> float:
    name = segment.split(".")[0]
    return CENTROID_STD_M.get(name) or LIMB_STD_M.get(name, 0.1)


def _frame_likelihood(
    camera: Camera,
    tracks: RegionTracks,
    frame: int,
    deviation: Array,
    floor_m: float | None,
    floor_std_m: float,
    noise_scales: NoiseScales,
    hips: Array | None,
) -> FrameLikelihood:
    visible = tracks.visible[frame] & (tracks.quality[frame] > LEAST_QUALITY)
    rotation, location = camera.pose(frame)
    right, up, backward = rotation.T
    pixels = np.where(visible[:, None], tracks.centroid[frame], camera.principal_point)
    _, ray = camera.rays(pixels, frame)
    away = -ray @ backward
    x, y = ray @ right / away, ray @ up / away
    lost = ~np.isfinite(x + y)
    visible, x, y = visible & ~lost, np.where(lost, 0.0, x), np.where(lost, 0.0, y)
    image_axes = np.stack([right + x[:, None] * backward, up + y[:, None] * backward], axis=1)  # (M, 2, 3)
    weight = np.where(visible, np.sqrt(np.clip(tracks.quality[frame], LEAST_QUALITY, 1.0)) / deviation, 0.0)
    by_hips, by_posture = _linear_rows(weight, image_axes, location, floor_m, floor_std_m, hips)
    variants: list[slice | None] = [None, *(slice(2 * m, 2 * m + 2) for m in np.flatnonzero(visible))]
    if floor_m is not None:
        variants.append(slice(len(by_hips) - 1, None))  # for jumps higher than the library's
    hips_map = np.stack([_hips_map(by_hips, by_posture, rows) for rows in variants])
    residual_map = by_posture + by_hips @ hips_map
    hips_map[:, :, -1] += location
    pixel_size = 1.0 / camera.focal_px
    moments = tracks.second_moment[frame] * pixel_size**2
    unclipped = visible & ~tracks.clipped[frame]
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
        float(
            2.0 * np.log(noise_scales.centroid[visible]).sum()
            + 3.0 * np.log(noise_scales.extent[unclipped]).sum()
        ),
        pixel_size,
        visible,
        unclipped,
    )


def _linear_rows(
    weight: Array,
    image_axes: Array,
    location: Array,
    floor_m: float | None,
    floor_std_m: float,
    hips: Array | None,
) -> tuple[Array, Array]:
    """Jacobians of the residuals by the hips (2 M + 4, 3) and by a posture's features (2 M + 4, 3 M + 2)."""
    markers = len(weight)
    rows = 2 * markers + 4
    by_hips, by_posture = np.zeros((rows, 3)), np.zeros((rows, 3 * markers + 2))
    for marker in range(markers):
        pair = weight[marker] * image_axes[marker]
        by_hips[2 * marker : 2 * marker + 2] = pair
        by_posture[2 * marker : 2 * marker + 2, 3 * marker : 3 * marker + 3] = pair
    if hips is not None:
        by_hips[-4:-1] = np.eye(3) / HIPS_STD_M
        by_posture[-4:-1, -1] = (location - hips) / HIPS_STD_M
    if floor_m is not None:
        by_hips[-1, 2] = 1.0 / floor_std_m
        by_posture[-1, -2] = -1.0 / floor_std_m
        by_posture[-1, -1] = (location[2] - floor_m) / floor_std_m
    return by_hips, by_posture


def _hips_map(by_hips: Array, by_posture: Array, downweighted: slice | None) -> Array:
    """(3, 3 M + 2) least-squares solution for the hips, relative to the camera; some rows downweighted."""
    trust = np.ones(len(by_hips))
    if downweighted is not None:
        trust[downweighted] = DOWNWEIGHT
    weighted = by_hips.T * trust**2
    return np.asarray(-np.linalg.solve(weighted @ by_hips + np.eye(3) / WEAK_STD_M**2, weighted @ by_posture))


def square_root(xx: Array, xy: Array, yy: Array) -> tuple[Array, Array, Array]:
    """Square root of symmetric 2 x 2 matrices, given and returned by entries."""
    root = np.sqrt(np.maximum(xx * yy - xy * xy, 0.0))
    scale = 1.0 / np.sqrt(np.maximum(xx + yy + 2.0 * root, 1e-12))
    return (xx + root) * scale, xy * scale, (yy + root) * scale
