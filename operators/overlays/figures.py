"""Plane figures as arrays: line segments, dashes, circles, diamonds, a body's limbs; nothing is drawn.

Points are region pixels unless stated otherwise. A point that is not finite breaks a line.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.arrays import Array


def segments(points: ArrayLike, *, closed: bool = False) -> Array:
    """Cut lines (..., N, D) into segments (S, 2, D); those with an end that is not finite are left out."""
    line = np.asarray(points, dtype=np.float64)
    ends = np.roll(line, -1, axis=-2) if closed else line[..., 1:, :]
    starts = line if closed else line[..., :-1, :]
    pairs = np.stack([starts, ends], axis=-2).reshape(-1, 2, line.shape[-1])
    return pairs[np.isfinite(pairs).all(axis=(-2, -1))]


def dashes(points: ArrayLike, dash: float, gap: float, *, closed: bool = False) -> Array:
    """Cut one line (N, D) into dashes (S, 2, D) that run on around its corners, anew where it is broken."""
    line = np.asarray(points, dtype=np.float64)
    if closed and len(line):
        line = np.concatenate([line, line[:1]])
    finite = np.isfinite(line).all(axis=-1)
    parts = [np.empty((0, 2, line.shape[-1]))]
    for run in [line] if finite.all() else np.split(line, np.flatnonzero(np.diff(finite)) + 1):
        steps = np.linalg.norm(np.diff(run, axis=0), axis=-1)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        if not along[-1] > 0.0:  # a point, or what is not finite
            continue
        period, share = max(dash + gap, along[-1] / 1000), dash / (dash + gap)
        starts = np.arange(0.0, along[-1], period)
        cuts = np.sort(np.concatenate([along, starts, starts + share * period]))
        cuts = cuts[: np.searchsorted(cuts, along[-1], side="right")]
        middles = 0.5 * (cuts[1:] + cuts[:-1])
        inked = ((middles / period) % 1.0 < share) & (cuts[1:] > cuts[:-1])
        at = np.stack([np.interp(cuts, along, column) for column in run.T], axis=-1)
        parts.append(np.stack([at[:-1], at[1:]], axis=1)[inked])
    return np.concatenate(parts)


def circles(centers: ArrayLike, radii: ArrayLike, corners: int = 24) -> Array:
    """(N, corners, 2) circles around centers (N, 2) with radii (N,) or one for all."""
    middle = np.asarray(centers, dtype=np.float64).reshape(-1, 1, 2)
    reach = np.broadcast_to(np.asarray(radii, dtype=np.float64), middle.shape[:1])
    turn = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    return middle + reach[:, None, None] * np.stack([np.cos(turn), np.sin(turn)], axis=-1)


def diamonds(centers: ArrayLike, radius: float) -> Array:
    """(N, 4, 2) squares standing on a corner around centers (N, 2), as Blender draws keys."""
    return circles(centers, radius, 4)


def triangles(polygons: ArrayLike) -> Array:
    """Cut convex polygons (N, K, D) into triangles (N * (K - 2), 3, D), without those that are not finite."""
    corners = np.asarray(polygons, dtype=np.float64)
    count, dimensions = corners.shape[-2:]
    first = np.broadcast_to(corners[:, :1], (len(corners), count - 2, dimensions))
    fans = np.stack([first, corners[:, 1:-1], corners[:, 2:]], axis=-2).reshape(-1, 3, dimensions)
    return fans[np.isfinite(fans).all(axis=(-2, -1))]


def polygons(*corners: tuple[Array, Array | float]) -> Array:
    """(N, K, 2) from K corners: their horizontal places (N,), and the vertical ones, (N,) or one for all."""
    return np.stack([np.stack(np.broadcast_arrays(*corner), axis=-1) for corner in corners], axis=1)


def squares(centers: Array, size: float) -> Array:
    """(N, 4, 2) upright squares about centers (N, 2), as large as a diamond of this size."""
    half = 0.8 * size
    corners = np.array([(-half, -half), (half, -half), (half, half), (-half, half)])
    return np.asarray(centers[:, None] + corners)


NECK, PELVIS = "neck", "pelvis"  # the middle between the shoulders, and between the hips
LIMBS = (
    ("", "head", NECK),
    ("", NECK, PELVIS),
    ("", "shoulder.L", "shoulder.R"),
    ("", "hip.L", "hip.R"),
    *(
        (side, f"{start}.{side}", f"{end}.{side}")
        for side in ("L", "R")
        for start, end in (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle"))
    ),
)
"""Side and ends of each line."""


def limb_lines(names: tuple[str, ...], positions: Array) -> tuple[Array, NDArray[np.str_]]:
    """Finite lines (N, 2, 2) of a body from its points (13, 2), and their sides (N,): L, R or none."""
    at = dict(zip(names, positions, strict=True))
    at[NECK] = 0.5 * (at["shoulder.L"] + at["shoulder.R"])
    at[PELVIS] = 0.5 * (at["hip.L"] + at["hip.R"])
    lines = np.array([[at[start], at[end]] for _, start, end in LIMBS])
    seen = np.isfinite(lines).all(axis=(-2, -1))
    return lines[seen], np.array([side for side, _, _ in LIMBS])[seen]


UPRIGHT = np.array([[1.0, 0.0], [0.0, 1.0]])
SLANTING = np.array([[1.0, 1.0], [1.0, -1.0]]) / 2.0**0.5
