"""Contact sheet of a character's motion: the footage, the character through its camera, and from the side."""

from collections.abc import Mapping

import numpy as np

from ..arrays import Array, Image
from ..camera.camera import Camera
from .canvas import GRID_M, PAPER, Canvas, ascii_text, draw_grid, side_directions
from .mannequin import CharacterFigure, draw_character
from .overlay_sheet import GAP, frame_label, sheet
from .stick_figure import square_of, squares_around

SIDE = 220
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
    title = ascii_text(f"{name}: through the camera, and from the side")
    words = (
        f"From the side in parallel projection about the hips; grid of {GRID_M:g} m. Numbers: scene frames."
    )
    rows = 3 if images else 2
    canvas, cells = sheet(title, words, figures, len(figures), SIDE, rows * (SIDE + GAP) - GAP)
    points = {frame: figure.points for frame, figure in figures.items()}
    centers, side_px = squares_around(points, camera, list(figures))
    side_m = ROOM * max(np.ptp(figure.points, axis=0).max() for figure in figures.values())
    for cell, corner in zip(cells, centers - 0.5 * side_px, strict=True):

        def project(places: Array, frame: int = cell.frame, corner: Array = corner) -> tuple[Array, Array]:
            pixels, depth = camera.project(places, frame)
            return (pixels - corner) * (SIDE / side_px), depth

        figure, image = figures[cell.frame], images.get(cell.frame)
        through = Canvas(SIDE, SIDE, PAPER)
        tiles = [Canvas(SIDE, SIDE, PAPER).image()] * (rows - 2)
        if image is not None:
            tiles = [square_of(image, corner, side_px, camera.resolution)]
        draw_character(through, figure, project)
        tiles += [through.image(), _from_side(figure, camera, side_m, floor_m)]
        for row, tile in enumerate(tiles):
            canvas.paste(tile, cell.left, cell.top + row * (SIDE + GAP), SIDE, SIDE)
        frame_label(canvas, cell, cell.frame + frame_start, keyframe=False)
    return canvas.image()


def _from_side(figure: CharacterFigure, camera: Camera, side_m: float, floor_m: float) -> Image:
    """The character from its left side as the camera sees it, over a grid that begins at the floor."""
    axes = side_directions(camera)
    middle = 0.5 * (figure.points.min(axis=0) + figure.points.max(axis=0))
    scale = SIDE / side_m
    low_m = min(float(figure.points[:, 2].min()), floor_m) - 0.5 * (1.0 - 1.0 / ROOM) * side_m
    tile = Canvas(SIDE, SIDE, PAPER)
    draw_grid(tile, scale, SIDE - scale * (floor_m - low_m))

    def project(points: Array) -> tuple[Array, Array]:
        right, _, away = axes @ (points - middle).T
        pixels = np.stack([0.5 * SIDE + scale * right, SIDE - scale * (points[:, 2] - low_m)], axis=-1)
        return pixels, away

    draw_character(tile, figure, project)
    return tile.image()
