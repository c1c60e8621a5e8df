"""Which samples of a marker nearer body parts hide.

A part hides a sample where its own outline in the image covers the sample and its axis lies nearer to
the camera there. Both edges are soft, so that the prediction changes smoothly with the posture.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit

from ..body.kinematics import Pose
from ..body.shapes import PieceStack
from ..footage.camera import Camera
from .outline import view_pieces

Array = NDArray[np.float64]

DEPTH_SOFTNESS_M = 0.02
EDGE_SOFTNESS_PX = 0.7
HIDDEN_DEPTH_M = 0.01
"""A part must lie this much nearer to hide another: neighbours share their joint's depth."""
NEGLIGIBLE = 8.0
"""Softness widths after which a part's effect is nothing."""


@dataclass(frozen=True, eq=False)
class Covers:
    """Image outlines of the O parts that may hide others, per frame; the last axis runs over both ends."""

    start: Array
    """(F, O, 2) image of the axis' first end [px]."""
    end: Array
    depth: Array
    """(F, O, 2) camera depth of both ends [m]."""
    half_width: Array
    """(F, O, 2) half-width of the outline at both ends [px]."""
    overshoot: Array
    """(F, O, 2) how far the outline reaches past both ends along the axis [px]."""

    def pick(self, frame: NDArray[np.intp], part: NDArray[np.intp]) -> "Covers":
        """R parts, each in a frame of its own, with arrays (R, 2)."""
        return Covers(
            self.start[frame, part],
            self.end[frame, part],
            self.depth[frame, part],
            self.half_width[frame, part],
            self.overshoot[frame, part],
        )


def covers(parts: PieceStack, pose: Pose, camera: Camera, frame: NDArray[np.intp]) -> Covers:
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
    return Covers(start, end, depth, half, past)


def visible_share(pixels: Array, depth: Array, parts: Covers, own: NDArray[np.bool_]) -> Array:
    """How much of each sample no part hides, 0 to 1.

    Args:
        pixels: (F, Q, S, 2) image places of the samples of Q pieces [px].
        depth: (F, Q, S) camera depths [m].
        parts: The O parts of the body.
        own: (Q, O) whether a part belongs to the piece's own marker and cannot hide it.

    Returns:
        (F, Q, S).
    """
    seen = np.ones(depth.shape)
    frame, piece, part = np.nonzero(_may_hide(pixels, depth, parts) & ~own)
    if len(frame):
        shown = 1.0 - _hidden_share(pixels[frame, piece], depth[frame, piece], parts.pick(frame, part))
        first = np.flatnonzero(np.diff(frame * len(own) + piece, prepend=-1))  # of each piece in each frame
        seen[frame[first], piece[first]] = np.multiply.reduceat(shown, first, axis=0)
    return seen


def _may_hide(pixels: Array, depth: Array, parts: Covers) -> NDArray[np.bool_]:
    """(F, Q, O) whether a part's bounding circle meets a piece's samples and reaches nearer."""
    centre = pixels.mean(axis=2)
    offset = pixels - centre[:, :, None]
    radius = np.sqrt(np.einsum("fqsi,fqsi->fqs", offset, offset).max(axis=2))
    middle = 0.5 * (parts.start + parts.end)
    extent = 0.5 * np.linalg.norm(parts.end - parts.start, axis=-1)
    extent = extent + np.maximum(parts.half_width, parts.overshoot).max(axis=-1)
    between = middle[:, None] - centre[:, :, None]  # (F, Q, O, 2)
    reach = radius[:, :, None] + extent[:, None] + NEGLIGIBLE * EDGE_SOFTNESS_PX
    close = np.einsum("fqoi,fqoi->fqo", between, between) < reach**2
    margin = HIDDEN_DEPTH_M - NEGLIGIBLE * DEPTH_SOFTNESS_M
    return np.asarray(close & (parts.depth.min(-1)[:, None] + margin < depth.max(2)[:, :, None]))


def _hidden_share(pixels: Array, depth: Array, part: Covers) -> Array:
    """How far one part hides samples (R, S) in R chosen frames."""
    axis = part.end - part.start
    length = np.maximum(np.linalg.norm(axis, axis=-1), 1e-6)
    along = axis / length[:, None]
    offset = pixels - part.start[:, None]
    run = offset[..., 0] * along[:, None, 0] + offset[..., 1] * along[:, None, 1]
    away = offset[..., 1] * along[:, None, 0] - offset[..., 0] * along[:, None, 1]
    share = np.clip(run / length[:, None], 0.0, 1.0)
    past = np.maximum(np.maximum(-run, run - length[:, None]), 0.0)

    def at(ends: Array) -> Array:
        return np.asarray(ends[:, None, 0] + share * (ends[:, 1] - ends[:, 0])[:, None])

    half = np.maximum(at(part.half_width), 0.5)
    reach = np.maximum(at(part.overshoot), 0.5)
    inside = (1.0 - np.sqrt((away / half) ** 2 + (past / reach) ** 2)) * half
    nearer = depth - at(part.depth) - HIDDEN_DEPTH_M
    return np.asarray(expit(inside / EDGE_SOFTNESS_PX) * expit(nearer / DEPTH_SOFTNESS_M))
