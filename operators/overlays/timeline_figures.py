"""Figures of the timeline overlay as arrays: graph, strip, squares, triangles [region px]."""

import numpy as np

from ...core.arrays import Array

UNSURE = np.array([0.90, 0.42, 0.10])
HALFWAY = np.array([0.93, 0.83, 0.35])
SURE = np.array([0.22, 0.55, 0.90])
"""Colors of low, middle and high confidence, also for color-blind eyes."""
DOUBTED = 0.5
"""Confidence up to which a frame has the lowest color: no better than chance that a joint is correct."""
FINEST_PX = 1.5
"""Frames nearer than this are drawn as one."""


def joined(x: Array, values: Array, *, lowest: bool) -> tuple[Array, Array]:
    """Merge frames that lie closer than can be seen, so that a long clip takes no longer to draw.

    Args:
        x: (F,) increasing positions.
        values: (F,) values there.
        lowest: Whether the lowest of the merged values is kept, or the highest.

    Returns:
        Positions and values, (N,) each.
    """
    if len(x) < 2 or x[-1] - x[0] >= FINEST_PX * (len(x) - 1):
        return x, values
    column = np.floor((x - x[0]) / FINEST_PX).astype(np.intp)
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    pick = np.fmin if lowest else np.fmax
    return x[starts], pick.reduceat(values, starts)


def in_view(x: Array, width: float) -> slice:
    """The frames at increasing positions (F,) that a region of this width shows, and one on each side."""
    first, last = np.searchsorted(x, (0.0, width))
    return slice(max(0, int(first) - 1), int(last) + 1)


def graph(x: Array, values: Array, floor: float, height: float) -> tuple[Array, Array]:
    """A curve and the area under it.

    Args:
        x: (N,) positions.
        values: (N,) heights, 0 to 1; NaN leaves a gap.
        floor: Height of 0.
        height: Distance from 0 to 1.

    Returns:
        The line (N, 2) and the area's pieces (N - 1, 4, 2).
    """
    line = np.stack([x, floor + height * values], axis=-1)
    foot = np.stack([x, np.full_like(x, floor)], axis=-1)
    area = np.stack([foot[:-1], foot[1:], line[1:], line[:-1]], axis=1)
    return line, area


def strip(x: Array, confidence: Array, floor: float, height: float) -> tuple[Array, Array]:
    """A bar for each frame: the higher and bluer, the higher its confidence.

    Args:
        x: (N,) positions.
        confidence: (N,) 0 to 1; NaN leaves a gap.
        floor: Foot of the bars.
        height: Height of a bar of confidence 1.

    Returns:
        Bars (N, 4, 2) and their opaque colors (N, 4).
    """
    middles = 0.5 * (x[1:] + x[:-1])
    reach = 0.5 * (x[1] - x[0]) if len(x) > 1 else 2.0
    left = np.concatenate([[x[0] - reach], middles])
    right = np.concatenate([middles, [x[-1] + reach]])
    top = floor + height * confidence
    bottom = np.where(np.isfinite(top), floor, np.nan)
    bars = np.stack(
        [
            np.stack(corner, axis=-1)
            for corner in ((left, bottom), (right, bottom), (right, top), (left, top))
        ],
        axis=1,
    )
    return bars, np.column_stack([confidence_color(confidence), np.ones(len(x))])


def confidence_color(confidence: Array) -> Array:
    """Colors (N, 3) of confidences (N,)."""
    share = np.nan_to_num(np.clip((confidence - DOUBTED) / (1.0 - DOUBTED), 0.0, 1.0))
    stops = np.stack([UNSURE, HALFWAY, SURE])
    return np.stack([np.interp(share, (0.0, 0.5, 1.0), column) for column in stops.T], axis=-1)


def squares(centers: Array, size: float) -> Array:
    """(N, 4, 2) upright squares about centers (N, 2), as large as a diamond of this size."""
    half = 0.8 * size
    corners = np.array([(-half, -half), (half, -half), (half, half), (-half, half)])
    return np.asarray(centers[:, None] + corners)


def pointers(x: Array, tip: float, size: float) -> Array:
    """(N, 3, 2) triangles that point down to a height at positions (N,)."""
    half, top = 0.6 * size, np.full_like(x, tip + size)
    corners = ((x, np.full_like(x, tip)), (x + half, top), (x - half, top))
    return np.stack([np.stack(corner, axis=-1) for corner in corners], axis=1)
