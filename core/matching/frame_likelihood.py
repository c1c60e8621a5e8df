"""What the footage says in each frame, in a form in which a posture's place before the camera is linear.

A marker whose middle lies at r from the hips is seen at the normalized image place (x, y) where
(a + x k) (T + r) = 0 and (b + y k) (T + r) = 0, with T the hips relative to the camera, a and b the camera's
axes to the right and up and k its backward axis in the world. Weighted least squares gives T, and what is
left over, as fixed matrices of a frame times what is known of a posture: every posture and heading in one
product.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..footage.camera import Camera
from ..footage.region_tracks import RegionTracks
from .noise_scales import Habits
from .posed_constraints import HIPS_STD_M, Anchors

MIDDLE_STD_M = {"trunk": 0.05, "pelvis": 0.04, "chest": 0.06, "head": 0.07, "girdle": 0.06}
"""How far a marker lies from where the same moment of another performer's motion has it, the hips aligned."""
LIMB_STD_M = {"upper_arm": 0.07, "forearm": 0.11, "hand": 0.14, "thigh": 0.05, "shin": 0.09, "foot": 0.12}
ROOT_STD_M = 0.025
"""How far off a marker's extent is: clothes, the color's ends, a limb turned by a few degrees."""
LEAST_QUALITY = 0.05
DOUBTED = 0.15
"""Share of its weight that a marker keeps in finding the place, where another performer holds that limb
otherwise: among all places tried the likeliest counts."""
FAR_M = 1e3
"""Holds the place of a body of which too little is seen; of no weight beside any marker."""


@dataclass(frozen=True, eq=False)
class Sight:
    """One frame: the maps that take a posture's numbers to its place and to what is left over.

    A posture's numbers are its markers' middles (3 M), its height above the floor, and 1.
    """

    place: Array
    """(V, 3, 3 M + 2) the hips' place in the world [m], with all trusted, then with each marker
    doubted, then the floor."""
    left: Array
    """(V, 2 M + 4, 3 M + 2) residuals in standard deviations: two a marker, three of the hips where they are
    posed, and the floor's."""
    weight: Array
    """(M,) of each marker's middle, one over its standard deviation [1/m]; 0 where it is not seen."""
    information: Array
    """(3, 3) of the hips' place [1/m²]."""
    backward: Array
    """(3,) the camera's backward axis in the world."""
    location: Array
    """(3,) the camera's place [m]."""
    axes: Array
    """(M, 2, 3) directions in the world in which a marker's image spreads to the right and upwards."""
    root: Array
    """(M, 3) square root of the observed second moments, per meter of depth: xx, xy, yy; average size."""
    root_std_m: Array
    """(M,) of their difference from the predicted ones."""
    constant: float
    """What is added to costs, so that performers of other habits can be compared."""
    pixel: float
    """What a pixel spans per meter of depth."""
    seen: BoolArray
    """(M,) markers that are seen."""
    whole: BoolArray
    """(M,) those whose region is not cut off."""


def sights(
    camera: Camera,
    tracks: RegionTracks,
    segments: tuple[str, ...],
    frames: IndexArray,
    floor_m: float | None,
    floor_std_m: float,
    habits: Habits | None = None,
    anchors: Anchors | None = None,
) -> list[Sight]:
    """The sights of some frames.

    Args:
        camera: The camera.
        tracks: The markers' regions.
        segments: The segment of each of the M markers.
        frames: Which frames.
        floor_m: Height of the floor; None where it is not known.
        floor_std_m: How far a posture's height above it may be off.
        habits: What is known of the performer.
        anchors: What is posed.
    """
    known = habits or Habits.unknown(len(segments))
    deviation = known.middle * [_deviation(segment) for segment in segments]
    posed = [None if anchors is None else anchors.place_at(int(frame)) for frame in frames]
    return [
        _sight(camera, tracks, int(frame), deviation, floor_m, floor_std_m, known, hips)
        for frame, hips in zip(frames, posed, strict=True)
    ]


def _deviation(segment: str) -> float:
    name = segment.split(".")[0]
    return MIDDLE_STD_M.get(name) or LIMB_STD_M.get(name, 0.1)


def _sight(
    camera: Camera,
    tracks: RegionTracks,
    frame: int,
    deviation: Array,
    floor_m: float | None,
    floor_std_m: float,
    habits: Habits,
    hips: Array | None,
) -> Sight:
    markers = len(deviation)
    seen = tracks.visible[frame] & (tracks.quality[frame] > LEAST_QUALITY)
    rotation, location = camera.pose(frame)
    right, up, back = rotation.T
    pixels = np.where(seen[:, None], tracks.centroid[frame], camera.principal_point)
    _, ray = camera.rays(pixels, frame)
    away = -ray @ back
    x, y = ray @ right / away, ray @ up / away
    lost = ~np.isfinite(x + y)
    seen, x, y = seen & ~lost, np.where(lost, 0.0, x), np.where(lost, 0.0, y)
    lines = np.stack([right + x[:, None] * back, up + y[:, None] * back], axis=1)  # (M, 2, 3)
    weight = np.where(seen, np.sqrt(np.clip(tracks.quality[frame], LEAST_QUALITY, 1.0)) / deviation, 0.0)
    rows = 2 * markers + 4
    by_place, by_posture = np.zeros((rows, 3)), np.zeros((rows, 3 * markers + 2))
    for marker in range(markers):
        pair = weight[marker] * lines[marker]
        by_place[2 * marker : 2 * marker + 2] = pair
        by_posture[2 * marker : 2 * marker + 2, 3 * marker : 3 * marker + 3] = pair
    if hips is not None:
        by_place[-4:-1] = np.eye(3) / HIPS_STD_M
        by_posture[-4:-1, -1] = (location - hips) / HIPS_STD_M
    if floor_m is not None:
        by_place[-1, 2] = 1.0 / floor_std_m
        by_posture[-1, -2] = -1.0 / floor_std_m
        by_posture[-1, -1] = (location[2] - floor_m) / floor_std_m
    doubts: list[slice | None] = [None, *(slice(2 * m, 2 * m + 2) for m in np.flatnonzero(seen))]
    if floor_m is not None:
        doubts.append(slice(rows - 1, None))  # who jumps higher than the library
    place = np.stack([_solved(by_place, by_posture, rows) for rows in doubts])
    left = by_posture + by_place @ place
    place[:, :, -1] += location
    pixel = 1.0 / camera.focal_px
    moments = tracks.second_moment[frame] * pixel**2
    whole = seen & ~tracks.clipped[frame]
    # Image rows run down, the camera's axis up.
    root = square_root(moments[:, 0, 0], -moments[:, 0, 1], moments[:, 1, 1])
    return Sight(
        place,
        left,
        weight,
        by_place.T @ by_place + np.eye(3) / FAR_M**2,
        back,
        location,
        lines,
        np.where(whole[:, None], np.stack(root, axis=-1), 0.0) / habits.size[:, None],
        ROOT_STD_M * habits.extent,
        float(2.0 * np.log(habits.middle[seen]).sum() + 3.0 * np.log(habits.extent[whole]).sum()),
        pixel,
        seen,
        whole,
    )


def _solved(by_place: Array, by_posture: Array, doubted: slice | None) -> Array:
    """(3, 3 M + 2) the place, relative to the camera, that leaves least where some rows hardly count."""
    trust = np.ones(len(by_place))
    if doubted is not None:
        trust[doubted] = DOUBTED
    weighted = by_place.T * trust**2
    return np.asarray(-np.linalg.solve(weighted @ by_place + np.eye(3) / FAR_M**2, weighted @ by_posture))


def square_root(xx: Array, xy: Array, yy: Array) -> tuple[Array, Array, Array]:
    """The square root of symmetric 2 x 2 matrices, given and returned by entries."""
    root = np.sqrt(np.maximum(xx * yy - xy * xy, 0.0))
    scale = 1.0 / np.sqrt(np.maximum(xx + yy + 2.0 * root, 1e-12))
    return (xx + root) * scale, xy * scale, (yy + root) * scale
