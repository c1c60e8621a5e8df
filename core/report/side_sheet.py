"""Contact sheet of the motion from the side, where its depth shows: the paper's Figures 10 and 11."""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array, Image
from ..footage.camera import Camera
from ..take.motion import Motion
from .canvas import Canvas
from .contact_sheet import LABEL, MARGIN, frame_label, sheet
from .stick_figure import draw_figure, legend, stick_figure
from .view_directions import draw_grid, side_directions

PAPER = (250, 249, 248)
COLUMNS = 6
CELL_WIDTH, CELL_HEIGHT = 220, 240
LIMB_WIDTH = 4.0
PADDING_M = 0.1
GRID_M = 0.5
FLOOR_WITHIN_M = 0.5


def side_sheet(motion: Motion, camera: Camera, frames: Sequence[int]) -> Image:
    """Draw stick figures of some frames about their hips, in parallel projection.

    Args:
        motion: The motion.
        camera: The camera, from whose right the side is seen.
        frames: Frame indices in the clip.

    Returns:
        (height, width, 3) picture.
    """
    axes, figure, floor = side_directions(camera), stick_figure(motion), _floor_height(motion)
    hips = motion.points[:, [motion.body.skeleton.point_names.index(f"hip.{side}") for side in ("L", "R")]]
    origin = hips.mean(axis=1) * [1.0, 1.0, 0.0]  # (F, 3): the ground under the hips
    seen = np.concatenate([limb.points for limb in figure.limbs], axis=1) - origin[:, None]
    seen = seen[list(frames)] @ axes[:2].T  # (K, N, 2)
    low, high = min(seen[..., 1].min(), floor), seen[..., 1].max() + figure.head_radius_m
    free = CELL_HEIGHT - LABEL  # the frame's number must not stand over the feet
    height = high - low + 2.0 * PADDING_M
    scale = float(min(0.5 * CELL_WIDTH / (np.abs(seen[..., 0]).max() + PADDING_M), free / height))
    foot = low - PADDING_M - 0.5 * (free / scale - height)  # height at the label's upper edge
    title = "Side view: the camera is to the left; depth runs to the right"
    footer = f"Parallel projection about the hips; grid of {GRID_M:g} m. Numbers: scene frames."
    canvas, cells = sheet(title, footer, frames, COLUMNS, CELL_WIDTH, CELL_HEIGHT)
    for cell in cells:
        tile = Canvas(cell.width, cell.height, PAPER)
        draw_grid(tile, scale * GRID_M, free - scale * (floor - foot))

        def project(points: Array, frame: int = cell.frame) -> tuple[Array, Array]:
            right, upward, away = axes @ (points - origin[frame]).T
            return np.stack([0.5 * CELL_WIDTH + scale * right, free - scale * (upward - foot)], axis=-1), away

        draw_figure(tile, figure, cell.frame, project, LIMB_WIDTH, outlined=False)
        canvas.paste(tile.image(), cell.left, cell.top, cell.width, cell.height)
        frame_label(canvas, cell, cell.frame + motion.frame_start, cell.frame in motion.keyframe_indices)
    legend(canvas, canvas.width - MARGIN, MARGIN + 15.0)
    return canvas.image()


def _floor_height(motion: Motion) -> float:
    """Height of the ground plane if the feet are near it, else of the lowest ankle [m]."""
    names = motion.body.skeleton.point_names
    lowest = float(motion.points[:, [names.index("ankle.L"), names.index("ankle.R")], 2].min())
    return 0.0 if abs(lowest) < FLOOR_WITHIN_M else lowest
