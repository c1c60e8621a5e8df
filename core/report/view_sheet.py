"""Contact sheets of the motion from the front, the side and above: the paper's Figures 10 and 11."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Image
from ..footage.camera import Camera
from ..take.motion import Motion
from .canvas import GRAY, PALE, Canvas
from .contact_sheet import LABEL, MARGIN, Cell, frame_label, sheet
from .stick_figure import StickFigure, draw_figure, legend, stick_figure
from .view_directions import view_directions

PAPER = (250, 249, 248)
COLUMNS = 6
CELL_WIDTH, CELL_HEIGHT = 220, 240
LIMB_WIDTH = 4.0
PADDING_M = 0.1
GRID_M = 0.5
FLOOR_WITHIN_M = 0.5
VIEWS = {
    "front": "Front view: along the camera's direction, level",
    "side": "Side view: the camera is to the left; depth runs to the right",
    "top": "Top view: the camera is below; depth runs up",
}


def view_sheet(view: str, motion: Motion, camera: Camera, frames: Sequence[int]) -> Image:
    """Draw stick figures of some frames about their hips, in parallel projection.

    Args:
        view: `front`, `side` or `top`.
        motion: The motion.
        camera: The camera, whose direction is the front.
        frames: Frame indices in the clip.

    Returns:
        (height, width, 3) picture.
    """
    axes = view_directions(view, camera)
    figure = stick_figure(motion)
    origin = _origin(motion, keep_height=view != "top")
    floor = None if view == "top" else _floor_height(motion)
    window = _window(figure, origin, axes, frames, floor)
    footer = f"Parallel projection about the hips; grid of {GRID_M:g} m. Numbers: scene frames."
    canvas, cells = sheet(VIEWS[view], footer, frames, COLUMNS, CELL_WIDTH, CELL_HEIGHT)
    for cell in cells:
        tile = _tile(cell, figure, origin[cell.frame], axes, window, floor)
        canvas.paste(tile, cell.left, cell.top, cell.width, cell.height)
        frame_label(canvas, cell, cell.frame + motion.frame_start, cell.frame in motion.keyframe_indices)
    legend(canvas, canvas.width - MARGIN, MARGIN + 15.0)
    return canvas.image()


@dataclass(frozen=True)
class _Window:
    """The part of the view's plane that a cell shows."""

    scale: float
    """Pixels a meter."""
    low_m: float
    """Height of the cell's lower edge above the origin."""


def _origin(motion: Motion, keep_height: bool) -> Array:
    """(F, 3) origin of the drawing of each frame: the hips' midpoint, or the ground under it [m]."""
    names = motion.body.skeleton.point_names
    hips = motion.points[:, [names.index("hip.L"), names.index("hip.R")]].mean(axis=1)
    return hips * [1.0, 1.0, 0.0] if keep_height else hips


def _floor_height(motion: Motion) -> float:
    """Height of the ground plane if the feet are near it, else of the lowest ankle [m]."""
    names = motion.body.skeleton.point_names
    lowest = float(motion.points[:, [names.index("ankle.L"), names.index("ankle.R")], 2].min())
    return 0.0 if abs(lowest) < FLOOR_WITHIN_M else lowest


def _window(
    figure: StickFigure, origin: Array, axes: Array, frames: Sequence[int], floor: float | None
) -> _Window:
    chosen = list(frames)
    points = np.concatenate([limb.points for limb in figure.limbs], axis=1)[chosen] - origin[chosen, None]
    across, heights = points @ axes[0], points @ axes[1]  # (K, N)
    low = heights.min() if floor is None else min(heights.min(), floor)
    high = heights.max() + figure.head_radius_m
    width, height = 2.0 * (np.abs(across).max() + PADDING_M), high - low + 2.0 * PADDING_M
    free = CELL_HEIGHT - LABEL  # the frame's number must not stand over the feet
    scale = min(CELL_WIDTH / width, free / height)
    spare = free / scale - height
    return _Window(scale, low - PADDING_M - 0.5 * spare - LABEL / scale)


def _tile(
    cell: Cell, figure: StickFigure, origin: Array, axes: Array, window: _Window, floor: float | None
) -> Image:
    tile = Canvas(cell.width, cell.height, PAPER)
    scale, middle = window.scale, 0.5 * cell.width
    for step in np.arange(-int(middle / scale / GRID_M), int(middle / scale / GRID_M) + 1) * GRID_M:
        tile.line([[middle + scale * step, 0.0], [middle + scale * step, cell.height]], PALE)
    base = 0.0 if floor is None else floor
    first = np.ceil((window.low_m - base) / GRID_M)
    for level in base + GRID_M * np.arange(first, first + cell.height / scale / GRID_M + 1):
        y = cell.height - scale * (level - window.low_m)
        tile.line([[0.0, y], [cell.width, y]], PALE)
    if floor is not None:
        y = cell.height - scale * (floor - window.low_m)
        tile.line([[0.0, y], [cell.width, y]], GRAY, 1.6)

    def project(points: Array) -> tuple[Array, Array]:
        right, upward, away = axes @ (points - origin).T
        points = np.stack([middle + scale * right, cell.height - scale * (upward - window.low_m)], axis=-1)
        return points, away

    draw_figure(tile, figure, cell.frame, project, LIMB_WIDTH, outlined=False)
    return tile.image()
