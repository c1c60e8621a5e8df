"""Contact sheet of the found postures over the footage: which are right, and which not?"""

from collections.abc import Mapping

import numpy as np

from ..arrays import Array, Image
from ..body.posture import Posture
from ..library.several_libraries import COMPOSED
from ..prior.keyframes import Keyframe, Matched
from ..take.take import Take
from .canvas import ACCENT, GRAY, INK, PALE, WHITE, Canvas
from .contact_sheet import MARGIN, Cell, frame_label, sheet
from .overlay_sheet import paler
from .stick_figure import draw_figure, legend, posed_figure

CELL_WIDTH = 300
COLUMNS = 5
MOST = 30
LIMB_WIDTH = 3.0
STRIP = 34
"""Height of the strip above each picture that holds the posture's name and its confidence."""


def shown_keyframes(take: Take, most: int = MOST) -> tuple[Keyframe, ...]:
    """The keyframes that a sheet shows: all, or evenly spaced ones of many."""
    count = len(take.keyframes)
    chosen = np.unique(np.round(np.linspace(0, count - 1, min(most, count))).astype(np.intp))
    return tuple(take.keyframes[index] for index in chosen)


def match_sheet(take: Take, images: Mapping[int, Image]) -> Image:
    """Draw a take's keyframes over its footage, each with the found posture's name and its confidence.

    Args:
        take: A take with found keyframes, and maybe posed ones.
        images: Frames of the clip by frame index, one for each of `shown_keyframes`.

    Returns:
        (height, width, 3) picture.
    """
    keyframes = [keyframe for keyframe in shown_keyframes(take) if keyframe.index in images]
    width, height = take.camera.resolution
    picture = round(CELL_WIDTH * height / width)
    found = [keyframe.matched for keyframe in take.keyframes if keyframe.matched is not None]
    names = {"all libraries" if said.library == COMPOSED else said.library for said in found}
    counts = f"{len(found)} of {len(take.keyframes)} keyframes"
    doubtful = sum(said.is_doubtful for said in found)
    title = _ascii(f"Found with {', '.join(sorted(names))}: {counts}, {doubtful} of them doubtful")
    footer = (
        "Bar: how probably the posture is about right, gray where doubtful. Numbers in the corner: scene "
        "frames; key: posed by hand."
    )
    canvas, cells = sheet(
        title, footer, [keyframe.index for keyframe in keyframes], COLUMNS, CELL_WIDTH, picture + STRIP
    )
    figure = posed_figure(
        take.body,
        Posture.stack([keyframe.posture for keyframe in keyframes]),
        np.array([keyframe.index / take.fps for keyframe in keyframes]),
    )
    for index, (cell, keyframe) in enumerate(zip(cells, keyframes, strict=True)):
        tile = Canvas(cell.width, picture)
        tile.paste(paler(images[cell.frame]), 0, 0, cell.width, picture)

        def project(points: Array, frame: int = cell.frame) -> tuple[Array, Array]:
            pixels, depth = take.camera.project(points, frame)
            return CELL_WIDTH / width * pixels, depth

        draw_figure(tile, figure, index, project, LIMB_WIDTH, outlined=True)
        canvas.paste(tile.image(), cell.left, cell.top + STRIP, cell.width, picture)
        frame_label(canvas, cell, cell.frame + take.frame_start, keyframe.matched is None)
        _caption(canvas, cell, keyframe.matched)
    legend(canvas, canvas.width - MARGIN, MARGIN + 15.0)
    return canvas.image()


def _caption(canvas: Canvas, cell: Cell, matched: Matched | None) -> None:
    """Name and confidence above a picture."""
    canvas.box(cell.left, cell.top, cell.left + cell.width, cell.top + STRIP, PALE)
    if matched is None:
        canvas.text("posed", cell.left + 7.0, cell.top + 15.0, 9.0, ACCENT)
        return
    percent = f"{'mirrored, ' if matched.mirrored else ''}{100.0 * matched.confidence:.0f}%"
    name = _ascii(matched.posture)
    room = cell.width - canvas.text_width(percent) - 24.0
    while len(name) > 4 and canvas.text_width(name) > room:
        name = f"{name.rstrip('.')[:-1]}..."
    right = cell.left + cell.width - 7.0
    canvas.text(name, cell.left + 7.0, cell.top + 15.0, 9.0, INK)
    canvas.text(percent, right, cell.top + 15.0, 9.0, INK, "right")
    left, y = cell.left + 7.0, cell.top + 24.0
    canvas.box(left, y, right, y + 4.0, WHITE)
    color = GRAY if matched.is_doubtful else ACCENT
    canvas.box(left, y, left + matched.confidence * (right - left), y + 4.0, color)


def _ascii(words: str) -> str:
    """The text in ASCII, which the canvas can write, with ? for every other character."""
    return words.encode("ascii", "replace").decode()
