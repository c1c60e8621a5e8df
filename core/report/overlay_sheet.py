"""Contact sheet of the footage with the estimate over it: does the skeleton lie on the performer?"""

from collections.abc import Mapping

import cv2
import numpy as np

from ..arrays import Array, Image
from ..footage.region_tracks import RegionTracks
from ..footage.segmentation.region_outlines import ellipse_outline
from ..take.motion import Motion
from ..take.take import Take
from .canvas import INK, WHITE, Canvas, Color
from .contact_sheet import MARGIN, Cell, frame_label, sheet
from .stick_figure import StickFigure, draw_figure, legend, stick_figure

CELL_WIDTH = 400
COLUMNS = 4
LIMB_WIDTH = 3.5


def overlay_sheet(take: Take, motion: Motion, tracks: RegionTracks, images: Mapping[int, Image]) -> Image:
    """Draw frames of the clip with the skeleton and each marker's region over them.

    Args:
        take: The take.
        motion: Its motion.
        tracks: The markers' regions.
        images: Frames of the clip by frame index, in the order to show them.

    Returns:
        (height, width, 3) picture.
    """
    width, height = take.camera.resolution
    cell_height = round(CELL_WIDTH * height / width)
    title = f"Estimate over the footage ({motion.method}, {len(motion.time_s)} frames)"
    footer = "Ellipse and cross: region found of each marker. Numbers: scene frames; key: posed by hand."
    canvas, cells = sheet(title, footer, list(images), COLUMNS, CELL_WIDTH, cell_height)
    figure = stick_figure(motion)
    for cell in cells:
        tile = _tile(take, figure, tracks, images[cell.frame], cell)
        canvas.paste(tile, cell.left, cell.top, cell.width, cell.height)
        frame_label(canvas, cell, cell.frame + motion.frame_start, cell.frame in motion.keyframe_indices)
    legend(canvas, canvas.width - MARGIN, MARGIN + 15.0)
    return canvas.image()


def _tile(take: Take, figure: StickFigure, tracks: RegionTracks, image: Image, cell: Cell) -> Image:
    """One frame on a canvas of its own, which clips what leaves the picture."""
    tile = Canvas(cell.width, cell.height)
    tile.paste(paler(image), 0, 0, cell.width, cell.height)
    scale = cell.width / take.camera.resolution[0]

    def project(points: Array) -> tuple[Array, Array]:
        pixels, depth = take.camera.project(points, cell.frame)
        return scale * pixels, depth

    draw_figure(tile, figure, cell.frame, project, LIMB_WIDTH, outlined=True)
    for marker, style in enumerate(take.markers):
        red, green, blue = style.color_srgb
        _draw_region(tile, tracks, cell.frame, marker, scale, (blue, green, red))
    return tile.image()


def paler(image: Image) -> Image:
    """The footage a little paler and grayer, so that drawings over it stand out."""
    gray = cv2.cvtColor(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), cv2.COLOR_GRAY2BGR)
    mixed = 0.7 * image.astype(np.float64) + 0.12 * gray + 0.18 * 255.0
    return np.asarray(np.clip(mixed, 0.0, 255.0), dtype=np.uint8)


def _draw_region(
    tile: Canvas, tracks: RegionTracks, frame: int, marker: int, scale: float, color: Color
) -> None:
    center = scale * tracks.centroid[frame, marker]
    if not np.isfinite(center).all():
        return
    outline = ellipse_outline(center, scale**2 * tracks.second_moment[frame, marker])
    tile.line(outline, WHITE, 2.6, closed=True)
    tile.line(outline, color, 1.4, closed=True)
    for step in (np.array([4.0, 0.0]), np.array([0.0, 4.0])):
        tile.line([center - step, center + step], WHITE, 2.4)
        tile.line([center - step, center + step], INK, 1.0)
