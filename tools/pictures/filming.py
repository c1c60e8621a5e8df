"""Good and bad filming side by side, one picture a point."""

import numpy as np
from keymark.core.arrays import Image
from keymark.core.report.canvas import INK, WHITE, Canvas, Color

from .filming_scenes import PAIRS, SIZE
from .photograph import photograph
from .shot import Shot

GAP, BAR = 8, 32
GOOD: Color = (82, 138, 30)
BAD: Color = (52, 56, 200)
LINE: Color = (40, 210, 255)


def draw_filming(name: str) -> Image:
    """The picture of a point of the guide, good on the left."""
    width, height = SIZE
    canvas = Canvas(2 * width + GAP, height + BAR)
    for column, shot in enumerate(PAIRS[name]):
        left = column * (width + GAP)
        canvas.paste(_marked(shot), left, 0, width, height)
        _label(canvas, left, shot.words, good=column == 0)
    return canvas.image()


def _marked(shot: Shot) -> Image:
    """A photograph with the lines that are drawn over it."""
    tile = Canvas(*SIZE)
    tile.paste(photograph(shot), 0, 0, *SIZE)
    for places in shot.lines:
        line, _ = shot.take.camera.project(places)
        tile.line(line, INK, 4.0)
        tile.line(line, LINE, 2.4)
        for end in line:
            tile.disc(end, 4.0, LINE)
    return tile.image()


def _label(canvas: Canvas, left: float, words: str, *, good: bool) -> None:
    """A tick or a cross, and a few words, below a photograph."""
    top, color = SIZE[1], GOOD if good else BAD
    canvas.box(left, top, left + SIZE[0], top + BAR, color)
    x, y = left + 18.0, top + 0.5 * BAR
    tick = [[x - 7, y], [x - 2, y + 6], [x + 8, y - 7]]
    strokes = [tick] if good else [[[x - 6, y - 6], [x + 6, y + 6]], [[x - 6, y + 6], [x + 6, y - 6]]]
    for stroke in strokes:
        canvas.line(np.array(stroke), WHITE, 2.6)
    canvas.text(words, left + 36.0, y + 5.0, 11.0, WHITE)
