"""Layout of a contact sheet: equal cells with a title, one for each frame."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from .canvas import ACCENT, GRAY, INK, WHITE, Canvas

MARGIN = 16
GAP = 8
TITLE = 34
FOOT = 22
LABEL = 20
"""Height of the frame's number within its cell."""


@dataclass(frozen=True)
class Cell:
    """A rectangle of the sheet for one frame."""

    frame: int
    """Index in the clip."""
    left: int
    top: int
    width: int
    height: int


def evenly_spaced_frames(frame_count: int, most: int = 12) -> tuple[int, ...]:
    """At most `most` frame indices of the clip, evenly spaced, with the first and the last."""
    return tuple(int(i) for i in np.unique(np.round(np.linspace(0, frame_count - 1, min(most, frame_count)))))


def sheet(
    title: str, footer: str, frames: Collection[int], columns: int, cell_width: int, cell_height: int
) -> tuple[Canvas, list[Cell]]:
    """A canvas with a title above, a line of explanation below, and a cell for each frame, row by row."""
    columns = min(columns, len(frames))
    rows = -(-len(frames) // columns)
    width = 2 * MARGIN + columns * cell_width + (columns - 1) * GAP
    height = MARGIN + TITLE + rows * cell_height + (rows - 1) * GAP + FOOT + MARGIN
    canvas = Canvas(width, height)
    canvas.text(title, MARGIN, MARGIN + 15, 12.0, INK)
    canvas.text(footer, MARGIN, height - MARGIN, 8.0, GRAY)
    cells = [
        Cell(
            frame,
            MARGIN + (index % columns) * (cell_width + GAP),
            MARGIN + TITLE + (index // columns) * (cell_height + GAP),
            cell_width,
            cell_height,
        )
        for index, frame in enumerate(frames)
    ]
    return canvas, cells


def frame_label(canvas: Canvas, cell: Cell, scene_frame: int, keyframe: bool) -> None:
    """Write a frame's number into the cell's bottom right corner; keyframes carry a diamond as well."""
    words = f"{scene_frame} key" if keyframe else f"{scene_frame}"
    width = canvas.text_width(words) + (28.0 if keyframe else 14.0)
    right, bottom = cell.left + cell.width, cell.top + cell.height
    canvas.box(right - width, bottom - LABEL, right, bottom, ACCENT if keyframe else INK)
    canvas.text(words, right - 7.0, bottom - 5.5, 9.0, WHITE, "right")
    if keyframe:
        x, y = right - width + 11.0, bottom - 10.0
        canvas.polygon([[x - 4.5, y], [x, y - 4.5], [x + 4.5, y], [x, y + 4.5]], WHITE)
