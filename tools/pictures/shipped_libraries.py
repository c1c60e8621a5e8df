"""Some postures of every shipped library; `keymark library show NAME --sheet FILE` draws all of one."""

import numpy as np
from keymark.core.arrays import Image
from keymark.core.body.kinematics import Body
from keymark.core.prior.library import Library, LibraryPosture
from keymark.core.prior.registry import SHIPPED, find_libraries
from keymark.core.prior.texts import EVERY_LIBRARY
from keymark.core.report.canvas import GRAY, INK, Canvas
from keymark.core.report.mannequin import posture_picture

FIGURES, CELL = 8, 116
TITLE, GAP = 190, 4


def some_postures(library: Library) -> list[LibraryPosture]:
    """A few postures, evenly spaced in the library's order."""
    places = np.unique(np.linspace(0, len(library.postures) - 1, FIGURES).round().astype(int))
    return [library.postures[place] for place in places]


def draw_libraries() -> Image:
    """Draw a row a library."""
    libraries = find_libraries(EVERY_LIBRARY, [SHIPPED])
    row = CELL + GAP
    canvas = Canvas(TITLE + FIGURES * (CELL + GAP), len(libraries) * row)
    for number, library in enumerate(libraries):
        top, body = number * row, Body(library.actor)
        canvas.text(library.title, GAP, top + 50, 11.0, INK)
        canvas.text(library.size, GAP, top + 70, 7.5, GRAY)
        for column, posture in enumerate(some_postures(library)):
            picture = posture_picture(body, posture.posture)
            canvas.paste(picture, TITLE + column * (CELL + GAP), top, CELL, CELL)
    return canvas.image()
