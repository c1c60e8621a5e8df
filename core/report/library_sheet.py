"""All postures of a library on one sheet, each with its name."""

from ..arrays import Image
from ..body.kinematics import Body
from ..library.library import Library
from .canvas import GRAY, INK, Canvas
from .captions import ascii_text, truncated
from .posture_picture import posture_picture

COLUMNS, CELL, CAPTION = 10, 128, 18
HEADER, MARGIN = 64, 16


def library_sheet(library: Library) -> Image:
    """Draw a library, (height, width, 3) blue, green, red."""
    body, count = Body(library.actor), len(library.postures)
    rows = -(-count // COLUMNS)
    canvas = Canvas(2 * MARGIN + COLUMNS * CELL, HEADER + rows * (CELL + CAPTION) + MARGIN)
    canvas.text(truncated(ascii_text(library.title), COLUMNS * CELL, 14.0), MARGIN, 32.0, 14.0, INK)
    words = f"{library.identifier}, version {library.version}, {library.size}, by {library.author}"
    canvas.text(truncated(ascii_text(words), COLUMNS * CELL, 8.5), MARGIN, 50.0, 8.5, GRAY)
    for index, entry in enumerate(library.postures):
        left, top = MARGIN + index % COLUMNS * CELL, HEADER + index // COLUMNS * (CELL + CAPTION)
        canvas.paste(posture_picture(body, entry.posture), left, top, CELL, CELL)
        name = truncated(ascii_text(entry.name), CELL - 6.0, 7.5)
        canvas.text(name, left + 0.5 * CELL, top + CELL + 11.0, 7.5, INK, "middle")
    return canvas.image()
