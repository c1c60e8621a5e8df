"""Self-occlusion: the share of each sample that stays visible behind nearer body parts.

A part occludes a sample where its outline in the image covers the sample and its axis lies nearer to
the camera there. Both edges are soft, so that the prediction changes smoothly with the posture.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.body_volume import PieceStack
from ..body.kinematics import Pose
from ..footage.camera import Camera
from .silhouette import view_pieces

DEPTH_SOFTNESS_M = 0.02
EDGE_SOFTNESS_PX = 0.7
HIDDEN_DEPTH_M = 0.01
"""Least depth difference of an occluding part: neighbors share their joint's depth."""
NEGLIGIBLE = 8.0
"""Softness widths beyond which a part's effect vanishes."""
BLOCK = 256
"""Pairs of a piece and a part that are evaluated at a time, so that their samples fit in the cache."""


@dataclass(frozen=True, eq=False)
class PartOutlines:
    """Image outlines of the O parts that may occlude others, per frame; the last axis runs over both ends."""

    start: Array
    """(F, O, 2) projection of the axis' first end [px]."""
    end: Array
    depth: Array
    """(F, O, 2) camera depth of both ends [m]."""
    half_width: Array
    """(F, O, 2) half-width of the outline at both ends [px]."""
    overshoot: Array
    """(F, O, 2) extent of the outline past both ends, along the axis [px]."""

    def pick(self, frame: IndexArray, part: IndexArray) -> "PartOutlines":
        """Select R pairs of a frame and a part; the arrays become (R, 2)."""
        return PartOutlines(
            self.start[frame, part],
            self.end[frame, part],
            self.depth[frame, part],
            self.half_width[frame, part],
            self.overshoot[frame, part],
        )


def part_outlines(parts: PieceStack, pose: Pose, camera: Camera, frame: IndexArray) -> PartOutlines:
    """The image outlines of all parts of the body."""
    view = view_pieces(parts, pose, camera, frame)
    start, start_depth = camera.project(view.start, frame[:, None])
    end, end_depth = camera.project(view.end, frame[:, None])
    depth = np.stack([start_depth, end_depth], -1)
    scale = camera.focal_px / np.maximum(depth, 1e-3)
    half, past = (
        np.linalg.norm(view.reach(direction)[:, :, None] * parts.half_widths, axis=-1) * scale
        for direction in (view.across, view.along)
    )
    return PartOutlines(start, end, depth, half, past)


def visible_share(pixels: Array, depth: Array, parts: PartOutlines, own: BoolArray) -> Array:
    """Visible share of each sample, 0 to 1.

    Args:
        pixels: (F, Q, S, 2) image points of the samples of Q pieces [px].
        depth: (F, Q, S) camera depths [m].
        parts: The O parts of the body.
        own: (Q, O) whether a part belongs to the piece's own marker and cannot occlude it.

    Returns:
        (F, Q, S).
    """
    seen = np.ones(depth.shape)
    frame, piece, part = np.nonzero(_may_hide(pixels, depth, parts) & ~own)
    if not len(frame):
        return seen
    columns, rows = pixels[..., 0], pixels[..., 1]
    shown = np.empty((len(frame), depth.shape[-1]))
    for start in range(0, len(frame), BLOCK):
        block = slice(start, start + BLOCK)
        where = frame[block], piece[block]
        picked = parts.pick(frame[block], part[block])
        shown[block] = 1.0 - _hidden_share(columns[where], rows[where], depth[where], picked)
    first = np.flatnonzero(np.diff(frame * len(own) + piece, prepend=-1))  # of each piece in each frame
    seen[frame[first], piece[first]] = np.multiply.reduceat(shown, first, axis=0)
    return seen


def outline_depth(pixels: Array, parts: PartOutlines) -> Array:
    """Camera depth (F, N, O) [m] of each part's axis where it covers pixels (F, N, 2), else infinite."""
    start, axis = parts.start[:, None], (parts.end - parts.start)[:, None]  # (F, 1, O, 2)
    length = np.maximum(np.linalg.norm(axis, axis=-1), 1e-6)
    x, y = np.moveaxis(pixels[:, :, None] - start, -1, 0)
    across, down = np.moveaxis(axis / length[..., None], -1, 0)
    run = x * across + y * down
    away = y * across - x * down
    on_axis = np.clip(run, 0.0, length)
    share = on_axis / length

    def at(ends: Array) -> Array:
        return np.asarray(ends[:, None, :, 0] + share * (ends[:, None, :, 1] - ends[:, None, :, 0]))

    half = np.maximum(at(parts.half_width), 0.5)
    past = (run - on_axis) * half / np.maximum(at(parts.overshoot), 0.5)
    return np.where(away * away + past * past < half * half, at(parts.depth), np.inf)


def _may_hide(pixels: Array, depth: Array, parts: PartOutlines) -> BoolArray:
    """(F, Q, O) whether a part's outline comes near a piece's bounding circle, and lies nearer in depth."""
    columns, rows = pixels[..., 0], pixels[..., 1]
    left, right, top, bottom = columns.min(-1), columns.max(-1), rows.min(-1), rows.max(-1)
    radius = 0.5 * np.hypot(right - left, bottom - top)
    # The nearest point of the part's axis to the circle's center.
    across, down = np.moveaxis((parts.end - parts.start)[:, None], -1, 0)  # (F, 1, O)
    first_x, first_y = np.moveaxis(parts.start[:, None], -1, 0)
    dx = 0.5 * (left + right)[..., None] - first_x  # (F, Q, O)
    dy = 0.5 * (top + bottom)[..., None] - first_y
    share = np.clip((dx * across + dy * down) / np.maximum(across**2 + down**2, 1e-6), 0.0, 1.0)
    dx, dy = dx - share * across, dy - share * down
    extent = np.maximum(parts.half_width, parts.overshoot).max(axis=-1)
    reach = radius[:, :, None] + extent[:, None] + NEGLIGIBLE * EDGE_SOFTNESS_PX
    close = dx**2 + dy**2 < reach**2
    margin = HIDDEN_DEPTH_M - NEGLIGIBLE * DEPTH_SOFTNESS_M
    return np.asarray(close & (parts.depth.min(-1)[:, None] + margin < depth.max(2)[:, :, None]))


def _hidden_share(columns: Array, rows: Array, depth: Array, part: PartOutlines) -> Array:
    """Occluded share of samples (R, S) behind one part each, in R selected frames."""
    axis = part.end - part.start
    squared = np.maximum((axis * axis).sum(-1, keepdims=True), 1e-12)
    along = axis / squared
    away_from = axis * (0.5 / EDGE_SOFTNESS_PX / np.sqrt(squared))
    # All lengths are in half softness widths from here on, the unit of the logistic.
    half = np.maximum(part.half_width, 0.5) * (0.5 / EDGE_SOFTNESS_PX)
    stretch = half / np.maximum(part.overshoot, 0.5) * np.sqrt(squared)
    axis_depth = (part.depth + HIDDEN_DEPTH_M) * (0.5 / DEPTH_SOFTNESS_M)

    share = _affine(columns, rows, along[:, :1], along[:, 1:], part.start)
    away = _affine(columns, rows, -away_from[:, 1:], away_from[:, :1], part.start)
    on_axis = np.clip(share, 0.0, 1.0)
    share -= on_axis  # past either end, where `on_axis` is 0 or 1
    share *= _between(stretch, on_axis)
    share *= share
    away *= away
    away += share
    inside = _between(half, on_axis)
    inside -= np.sqrt(away, out=away)
    nearer = depth * (0.5 / DEPTH_SOFTNESS_M)
    nearer -= _between(axis_depth, on_axis)
    hidden = _logistic_of_half(inside)
    hidden *= _logistic_of_half(nearer)
    return hidden


def _affine(columns: Array, rows: Array, right: Array, down: Array, origin: Array) -> Array:
    """Affine function of image points (R, S) with slopes (R, 1) that vanishes at `origin` (R, 2)."""
    value = columns * right
    value += rows * down
    value -= origin[:, :1] * right + origin[:, 1:] * down
    return value


def _between(ends: Array, share: Array) -> Array:
    """Linear interpolation between both ends' values (R, 2), at shares (R, S)."""
    value = share * (ends[:, 1:] - ends[:, :1])
    value += ends[:, :1]
    return value


def _logistic_of_half(x: Array) -> Array:
    """1 / (1 + exp(-2x)) in place, by the hyperbolic tangent, which cannot overflow and is fast."""
    np.tanh(x, out=x)
    x += 1.0
    x *= 0.5
    return x
