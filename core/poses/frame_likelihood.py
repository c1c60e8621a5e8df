"""What one frame shows, as postures are compared with it: places, depths and extents, under Student's t.

All is in single precision: thousands of postures are compared with every frame.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import BoolArray, IndexArray, SingleArray, single
from ..camera.camera import Camera
from ..numerics.robust import DEGREES, Floats, multivariate_cost
from .match_evidence import LEAST_QUALITY, MatchEvidence

ENTRIES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))  # of a symmetric matrix, as in `second_moment`


@dataclass(frozen=True, eq=False)
class FrameLikelihood:
    """One frame with A points."""

    weight: SingleArray  # (A,) one over the standard deviation of each place [1/m]; 0 where not visible
    backward: SingleArray  # (3,) the camera's backward axis in the world
    location: SingleArray  # (3,) the camera's place [m]
    image_axes: SingleArray  # (A, 2, 3) world directions of a point's image to the right and upwards
    extent: SingleArray
    """(A, 3) square root of a marker's observed second moments per meter of depth, xx, xy, yy."""
    sight: SingleArray  # (3,) line of sight to the performer, along which depths are guessed
    depth_m: SingleArray  # (A,) guessed depth of each behind the hips [m]; 0 where there is none
    depth_weight: SingleArray  # (A,) one over its standard deviation [1/m]; 0 where there is none
    pixel_size: float  # size of a pixel per meter of depth
    visible: BoolArray  # (A,) points found in the frame
    whole: BoolArray  # (A,) markers found whose region is not cut off by the picture's edge
    share: float  # weight of each point's cost, since they do not differ independently

    @cached_property
    def rows(self) -> SingleArray:
        """(A, 2, 3) image axes in standard deviations of each place."""
        return self.image_axes * self.weight[:, None, None]

    def extent_cost(self, marker: int, entries: Sequence[SingleArray], depth_m: SingleArray) -> SingleArray:
        """Cost of predicted second moments xx, xy, yy of a marker [m²] at some distances [m]."""
        depth = np.maximum(depth_m, np.float32(0.1))
        # Deviation of a marker's extent: clothes, the color's ends, a limb turned by a few degrees.
        variance = np.float32(0.025**2) + (np.float32(self.pixel_size) * depth) ** 2
        off = [(p - o * depth) ** 2 for p, o in zip(square_root(*entries), self.extent[marker], strict=True)]
        return multivariate_cost((off[0] + off[1] * np.float32(2.0) + off[2]) / variance, DEGREES, 3)


def frame_likelihood(
    camera: Camera, evidence: MatchEvidence, frame: int, scale: float = 1.0
) -> FrameLikelihood:
    """What a frame shows; `scale` is the deviation of what is compared, relative to another performer's."""
    tracks, markers = evidence.tracks, len(evidence.segments)
    rotation, location = camera.pose(frame)
    right, up, backward = rotation.T
    pixels = np.where(evidence.visible[frame][:, None], evidence.pixel[frame], camera.principal_point)
    _, ray = camera.rays(pixels, frame)
    away = -ray @ backward
    x, y = ray @ right / away, ray @ up / away
    lost = ~np.isfinite(x + y)
    visible, x, y = evidence.visible[frame] & ~lost, np.where(lost, 0.0, x), np.where(lost, 0.0, y)
    depth = np.full(len(visible), np.nan)
    depth[markers:] = evidence.keypoints.hint_m[frame, :, 2]
    known = np.isfinite(depth) & visible
    depth_weight = np.append(np.zeros(markers), 1.0 / evidence.depth_deviation_m)
    whole, extent = np.zeros(len(visible), dtype=bool), np.zeros((len(visible), 3))
    whole[:markers] = visible[:markers] & ~tracks.clipped[frame]
    moments = tracks.second_moment[frame] / camera.focal_px**2
    # Image rows run down, the camera's axis up.
    roots = np.stack(square_root(moments[:, 0, 0], -moments[:, 0, 1], moments[:, 1, 1]), axis=-1)
    extent[:markers] = np.where(whole[:markers, None], roots, 0.0)
    sight = ray[visible].mean(axis=0) if visible.any() else -backward
    trust = np.sqrt(np.clip(evidence.quality[frame], LEAST_QUALITY, 1.0))
    return FrameLikelihood(
        single(np.where(visible, trust / (scale * evidence.deviation_m), 0.0)),
        single(backward),
        single(location),
        single(np.stack([right + x[:, None] * backward, up + y[:, None] * backward], axis=1)),
        single(extent),
        single(sight / np.linalg.norm(sight)),
        single(np.where(known, depth, 0.0)),
        single(np.where(known, depth_weight, 0.0)),
        1.0 / camera.focal_px,
        visible,
        whole,
        evidence.share,
    )


def square_root(xx: Floats, xy: Floats, yy: Floats) -> tuple[Floats, Floats, Floats]:
    """Square root of symmetric 2 x 2 matrices, given and returned by entries."""
    root = np.sqrt(np.maximum(xx * yy - xy * xy, 0.0))
    scale = 1.0 / np.sqrt(np.maximum(xx + yy + 2.0 * root, 1e-12))
    return (xx + root) * scale, xy * scale, (yy + root) * scale


def image_moments(axes: SingleArray) -> tuple[SingleArray, SingleArray, SingleArray]:
    """(..., 6) coefficients of a matrix's `ENTRIES` in its image's xx, xy and yy by axes (..., 2, 3)."""
    first, second = axes[..., 0, :], axes[..., 1, :]

    def products(one: SingleArray, other: SingleArray) -> SingleArray:
        mixed = [one[..., i] * other[..., j] + one[..., j] * other[..., i] for i, j in ENTRIES[3:]]
        return np.stack([*np.moveaxis(one * other, -1, 0), *mixed], axis=-1)

    return products(first, first), products(first, second), products(second, second)


PAIRS = np.triu_indices(4)
_TWICE = np.where(PAIRS[0] == PAIRS[1], 1.0, 2.0).astype(np.float32)


def products(points: SingleArray) -> SingleArray:
    """(10, N) products of the coordinates of points (N, 3) and 1, in which squared distances are linear."""
    known = np.concatenate([points, np.ones((len(points), 1), dtype=np.float32)], axis=1).T
    return np.ascontiguousarray(known[PAIRS[0]] * known[PAIRS[1]] * _TWICE[:, None])


def spread(slopes: SingleArray, off: SingleArray) -> SingleArray:
    """(..., 10, N) whose product with `products` is 1 plus squared distances over the t's degrees.

    `slopes` (..., R, 3, N) and `off` (..., R, N), of a point at 0, of R rows give the distances in standard
    deviations.
    """
    rows = np.concatenate([slopes, off[..., None, :]], axis=-2)
    found = (rows[..., PAIRS[0], :] * rows[..., PAIRS[1], :]).sum(axis=-3) / np.float32(DEGREES)
    found[..., -1, :] += 1.0
    return np.asarray(found)


def squared_distances(first: SingleArray, second: SingleArray) -> SingleArray:
    """(J, K) mean squared distances of points (J, Q, 3) and (K, Q, 3)."""
    a, b = first.reshape(len(first), -1), second.reshape(len(second), -1)
    squared = (a * a).sum(axis=1)[:, None] + (b * b).sum(axis=1) - np.float32(2.0) * (a @ b.T)
    return np.maximum(squared, np.float32(0.0)) / np.float32(first.shape[1])


def lowest(cost: SingleArray, count: int, margin: float) -> IndexArray:
    """Indices of the lowest costs within a margin of the least, at most `count`, in order of index."""
    kept = np.flatnonzero(cost <= cost.min() + np.float32(margin))
    if len(kept) > count:
        kept = np.sort(kept[np.argpartition(cost[kept], count)[:count]])
    return kept
