"""Contact sheet of the footage with the estimate over it: does the skeleton lie on the performer?"""

from collections.abc import Mapping

import cv2
import numpy as np

from ..arrays import Array, Image
from ..footage.region_tracks import RegionTracks
from ..footage.segmentation.region_outlines import ellipse_outline
from ..observation.contours import ContourModel
from ..review.compared_keypoints import ComparedKeypoints
from ..take.motion import Motion
from ..take.take import Take
from .body_outlines import draw_outlines
from .canvas import INK, WHITE, Canvas, Color
from .contact_sheet import MARGIN, Cell, frame_label, sheet
from .keypoint_marks import draw_keypoint_legend, draw_keypoints
from .stick_figure import StickFigure, draw_figure, legend, stick_figure

CELL_WIDTH = 400
COLUMNS = 4
LIMB_WIDTH = 3.5


def overlay_sheet(
    take: Take,
    motion: Motion,
    tracks: RegionTracks,
    images: Mapping[int, Image],
    keypoints: ComparedKeypoints | None = None,
    contours: ContourModel | None = None,
) -> Image:
    """Draw frames of the clip with the skeleton and what was seen of the performer over them.

    Args:
        take: The take.
        motion: Its motion.
        tracks: The markers' regions.
        images: Frames of the clip by frame index, in the order to show them.
        keypoints: The performer's keypoints, if any.
        contours: The body's contours, drawn where there are no markers.

    Returns:
        (height, width, 3) picture.
    """
    width, height = take.camera.resolution
    cell_height = round(CELL_WIDTH * height / width)
    title = f"Estimate over the footage ({motion.method}, {len(motion.time_s)} frames)"
    outlines = None if tracks.names else contours
    footer = _footer(tracks, outlines)
    canvas, cells = sheet(title, footer, list(images), COLUMNS, CELL_WIDTH, cell_height)
    figure = stick_figure(motion)
    pose = motion.body.pose(motion.posture)
    scale = CELL_WIDTH / width
    for cell in cells:
        tile = Canvas(cell.width, cell.height)  # of its own, which clips what leaves the picture
        tile.paste(paler(images[cell.frame]), 0, 0, cell.width, cell.height)
        if outlines is not None:
            draw_outlines(tile, outlines, pose, cell.frame, lambda pixels: scale * pixels)
        _draw_estimate(tile, take, figure, tracks, cell)
        if keypoints is not None:
            draw_keypoints(tile, keypoints, cell.frame, lambda pixels: scale * pixels)
        canvas.paste(tile.image(), cell.left, cell.top, cell.width, cell.height)
        frame_label(canvas, cell, cell.frame + motion.frame_start, cell.frame in motion.keyframe_indices)
    legend(canvas, canvas.width - MARGIN, MARGIN + 15.0)
    if keypoints is not None and keypoints.names:
        left = MARGIN + canvas.text_width(footer, 8.0) + 2.0 * MARGIN
        draw_keypoint_legend(canvas, keypoints, left, canvas.width - MARGIN, canvas.height - MARGIN)
    return canvas.image()


def _footer(tracks: RegionTracks, outlines: ContourModel | None) -> str:
    """What the drawings over the footage are."""
    shown = ""
    if tracks.names:
        shown = "Ellipse and cross: region found of each marker. "
    elif outlines is not None:
        shown = "Lines beside the limbs: contours as the motion predicts them. "
    return f"{shown}Numbers: scene frames; key: posed by hand."


def _draw_estimate(tile: Canvas, take: Take, figure: StickFigure, tracks: RegionTracks, cell: Cell) -> None:
    """The skeleton and the markers' regions of one frame."""
    scale = cell.width / take.camera.resolution[0]

    def project(points: Array) -> tuple[Array, Array]:
        pixels, depth = take.camera.project(points, cell.frame)
        return scale * pixels, depth

    draw_figure(tile, figure, cell.frame, project, LIMB_WIDTH, outlined=True)
    for marker, style in enumerate(take.markers):
        red, green, blue = style.color_srgb
        _draw_region(tile, tracks, cell.frame, marker, scale, (blue, green, red))


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
