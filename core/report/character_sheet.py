"""Contact sheet of a character's motion: the footage, the character through its camera, and from the side."""

from collections.abc import Mapping

import numpy as np

from ..arrays import Array, Image
from ..camera.camera import Camera
from .canvas import GRAY, INK, PAPER, Canvas, ascii_text, draw_grid, side_directions
from .mannequin import CharacterFigure, draw_character
from .overlay_sheet import FOOT, GAP, MARGIN, TITLE, Cell, frame_label
from .stick_figure import square_of, squares_around

SIDE = 220
ROWS = ("footage", "camera", "side")
GRID_M = 0.5
ROOM = 1.15
"""Side of the view from the side, in heights or widths of the largest figure."""


def character_sheet(
    name: str,
    figures: Mapping[int, CharacterFigure],
    camera: Camera,
    images: Mapping[int, Image],
    frame_start: int,
    floor_m: float,
) -> Image:
    """Draw a character in some frames, beside the footage where there is any.

    Args:
        name: The character's name, for the title.
        figures: The character by frame index, in the order to show it.
        camera: The camera that took the footage; it decides what is the side.
        images: Frames of the clip by the same index, reduced or whole; those that are missing are left out.
        frame_start: Scene frame of index 0.
        floor_m: Height of the floor under the character [m].
    """
    rows = ROWS if images else ROWS[1:]
    frames = list(figures)
    width = 2 * MARGIN + len(frames) * SIDE + (len(frames) - 1) * GAP
    canvas = Canvas(width, 2 * MARGIN + TITLE + len(rows) * SIDE + (len(rows) - 1) * GAP + FOOT)
    canvas.text(ascii_text(f"{name}: through the camera, and from the side"), MARGIN, MARGIN + 15, 12.0, INK)
    words = (
        f"From the side in parallel projection about the hips; grid of {GRID_M:g} m. Numbers: scene frames."
    )
    canvas.text(words, MARGIN, canvas.height - MARGIN, 8.0, GRAY)
    corners, side_px = _crops(figures, camera)
    side_m = ROOM * max(np.ptp(figure.points, axis=0).max() for figure in figures.values())
    for column, (frame, corner) in enumerate(zip(frames, corners, strict=True)):
        left = MARGIN + column * (SIDE + GAP)
        tiles = {
            "footage": _footage(images.get(frame), corner, side_px, camera),
            "camera": _through_camera(figures[frame], camera, frame, corner, side_px),
            "side": _from_side(figures[frame], camera, side_m, floor_m),
        }
        for row, kind in enumerate(rows):
            canvas.paste(tiles[kind], left, MARGIN + TITLE + row * (SIDE + GAP), SIDE, SIDE)
        last = Cell(frame, left, MARGIN + TITLE + (len(rows) - 1) * (SIDE + GAP), SIDE, SIDE)
        frame_label(canvas, last, frame + frame_start, keyframe=False)
    return canvas.image()


def _crops(figures: Mapping[int, CharacterFigure], camera: Camera) -> tuple[Array, float]:
    """Corner (K, 2) of the square around the character in each frame, and their side [px]."""
    points = {frame: figure.points for frame, figure in figures.items()}
    centers, side = squares_around(points, camera, list(figures))
    return centers - 0.5 * side, side


def _footage(image: Image | None, corner: Array, side: float, camera: Camera) -> Image:
    if image is None:
        return Canvas(SIDE, SIDE, PAPER).image()
    return square_of(image, corner, side, camera.resolution)


def _through_camera(figure: CharacterFigure, camera: Camera, frame: int, corner: Array, side: float) -> Image:
    tile = Canvas(SIDE, SIDE, PAPER)

    def project(points: Array) -> tuple[Array, Array]:
        pixels, depth = camera.project(points, frame)
        return (pixels - corner) * (SIDE / side), depth

    draw_character(tile, figure, project)
    return tile.image()


def _from_side(figure: CharacterFigure, camera: Camera, side_m: float, floor_m: float) -> Image:
    """The character from its left side as the camera sees it, over a grid that begins at the floor."""
    axes = side_directions(camera)
    middle = 0.5 * (figure.points.min(axis=0) + figure.points.max(axis=0))
    scale = SIDE / side_m
    low_m = min(float(figure.points[:, 2].min()), floor_m) - 0.5 * (1.0 - 1.0 / ROOM) * side_m
    tile = Canvas(SIDE, SIDE, PAPER)
    draw_grid(tile, scale * GRID_M, SIDE - scale * (floor_m - low_m))

    def project(points: Array) -> tuple[Array, Array]:
        right, _, away = axes @ (points - middle).T
        pixels = np.stack([0.5 * SIDE + scale * right, SIDE - scale * (points[:, 2] - low_m)], axis=-1)
        return pixels, away

    draw_character(tile, figure, project)
    return tile.image()
