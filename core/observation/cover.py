"""Which samples of a marker nearer body parts hide.

A part hides a sample where its own outline in the image covers the sample and its axis lies nearer to
the camera there. Both edges are soft, so that the prediction changes smoothly with the posture.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..body.shapes import Piece
from ..footage.camera import Camera
from .outline import View

Array = NDArray[np.float64]

DEPTH_SOFTNESS_M = 0.02
EDGE_SOFTNESS_PX = 0.7
HIDDEN_DEPTH_M = 0.01
"""A part must lie this much nearer to hide another: neighbours share their joint's depth."""


@dataclass(frozen=True, eq=False)
class Cover:
    """The image outline of a part that may hide others, per frame."""

    segment: str
    start: Array
    """(F, 2) image of the axis' ends [px]."""
    end: Array
    depth: Array
    """(F, 2) camera depth of both ends [m]."""
    half_width: Array
    """(F, 2) half-width of the outline at both ends [px]."""
    overshoot: Array
    """(F, 2) how far the outline reaches past both ends along the axis [px]."""


def cover(piece: Piece, view: View, camera: Camera, frame: NDArray[np.intp]) -> Cover:
    """The image outline of a piece."""
    start, start_depth = camera.project(view.start, frame)
    end, end_depth = camera.project(view.end, frame)
    depth = np.stack([start_depth, end_depth], -1)
    scale = camera.focal_px / np.maximum(depth, 1e-3)
    half = np.stack([view.support(view.across, widths) for widths in piece.half_widths], -1)
    past = np.stack([view.support(view.along, widths) for widths in piece.half_widths], -1)
    return Cover(piece.segment, start, end, depth, half * scale, past * scale)


def hidden_share(samples: Array, depth: Array, part: Cover) -> Array:
    """How far a part hides samples, 0 to 1.

    Args:
        samples: (F, S, 2) image places [px].
        depth: (F, S) camera depths [m].
        part: The part in front, in the same frames.

    Returns:
        (F, S).
    """
    axis = part.end - part.start
    length = np.linalg.norm(axis, axis=-1)
    along = axis / np.maximum(length, 1e-6)[:, None]
    offset = samples - part.start[:, None]
    run = offset[..., 0] * along[:, None, 0] + offset[..., 1] * along[:, None, 1]
    away = np.abs(offset[..., 1] * along[:, None, 0] - offset[..., 0] * along[:, None, 1])
    share = np.clip(run / np.maximum(length, 1e-6)[:, None], 0.0, 1.0)
    past = np.maximum(np.maximum(-run, run - length[:, None]), 0.0)

    def at(ends: Array) -> Array:
        return np.asarray(ends[:, None, 0] + share * (ends[:, 1] - ends[:, 0])[:, None])

    half = np.maximum(at(part.half_width), 0.5)
    reach = np.maximum(at(part.overshoot), 0.5)
    inside = (1.0 - np.hypot(away / half, past / reach)) * half
    nearer = depth - at(part.depth) - HIDDEN_DEPTH_M
    edge = np.clip(inside / EDGE_SOFTNESS_PX, -30.0, 30.0)
    order = np.clip(nearer / DEPTH_SOFTNESS_M, -30.0, 30.0)
    return np.asarray(1.0 / ((1.0 + np.exp(-edge)) * (1.0 + np.exp(-order))))


def may_hide(samples: Array, depth: Array, part: Cover) -> NDArray[np.bool_]:
    """(F,) whether the part's bounding circle meets the samples' and reaches nearer: a cheap first test."""
    centre = samples.mean(axis=1)
    radius = np.linalg.norm(samples - centre[:, None], axis=-1).max(axis=1)
    middle = 0.5 * (part.start + part.end)
    extent = 0.5 * np.linalg.norm(part.end - part.start, axis=-1)
    extent = extent + np.maximum(part.half_width, part.overshoot).max(axis=-1)
    close = np.linalg.norm(middle - centre, axis=-1) < radius + extent + 3.0 * EDGE_SOFTNESS_PX
    return np.asarray(close & (part.depth.min(axis=-1) < depth.max(axis=-1)))
