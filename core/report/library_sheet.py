"""A library on one sheet: every motion as a strip of its postures, then the postures in no motion."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Image
from ..body.kinematics import Body
from ..body.posture import Posture
from ..library.library import Library, LibraryMotion, LibraryPosture
from .canvas import GRAY, INK, LEFT, RIGHT, Canvas, Color
from .captions import ascii_text, truncated, wrapped
from .mannequin import View, draw_mannequin, view_axes
from .posture_picture import FLESH_M, TILT_RAD, backdrop, best_view_turn, projected_landmarks

MARGIN = 28
LEAST_WIDTH, WIDTH = 900, 1520
"""Least and greatest width between the margins."""
SCALE = 86.0
"""Pixels a meter, the same for every figure."""
NARROWEST, WIDEST = 98, 230
"""Least and greatest width of a cell."""
HEADER, SECTION = 96, 34
STRIP_GAP, ROW_GAP = 40, 22
"""Space between two strips side by side, and below a row of strips."""
FLOOR_HEIGHT = 22
"""Height below the middle of the floor, for the nearer foot."""
LETTER_SIZE, LINE_HEIGHT, MOST_LINES = 8.0, 11.5, 3


@dataclass(frozen=True)
class _Strip:
    """Postures drawn side by side from one direction."""

    title: str
    detail: str
    cyclic: bool
    captions: tuple[tuple[str, str], ...]
    """Name and time of each posture."""
    postures: Posture
    """Batch of the postures."""
    turn_rad: float
    middle_m: float
    """Middle of a cell, to the right of the hips [m]."""
    cell: int
    """Width of one posture's cell."""
    figure_height: int
    """Height of the figures with their floor."""

    @property
    def columns(self) -> int:
        """Postures in a row; several rows share them evenly."""
        rows = -(-len(self.captions) * self.cell // WIDTH)
        return -(-len(self.captions) // rows)

    @property
    def lines(self) -> int:
        """Lines of the longest name."""
        return max(len(_name_lines(name, self.cell)) for name, _ in self.captions)

    @property
    def row_height(self) -> int:
        """Height of a row with its captions."""
        return self.figure_height + round(LINE_HEIGHT * (self.lines + 1)) + 12

    @property
    def height(self) -> int:
        """Height of the strip with its title."""
        return SECTION + self.row_height * -(-len(self.captions) // self.columns)

    @property
    def width(self) -> int:
        """Width of the strip with its title."""
        words = Canvas.text_width(self.title, 11.0) + Canvas.text_width(self.detail, 8.5) + 40.0
        return max(self.columns * self.cell, min(int(words), WIDTH))


def library_sheet(library: Library) -> Image:
    """Draw every posture of a library with its name and time, each motion a strip.

    Returns:
        (height, width, 3) blue, green, red.
    """
    body = Body(library.actor)
    rows = _packed_rows(_strips(library, body))
    heights = [max(strip.height for strip in row) + ROW_GAP for row in rows]
    widest = max(sum(strip.width + STRIP_GAP for strip in row) - STRIP_GAP for row in rows)
    canvas = Canvas(max(widest, LEAST_WIDTH) + 2 * MARGIN, HEADER + sum(heights))
    _draw_header(canvas, library)
    figures: list[tuple[int, int, _Strip, int]] = []
    top = HEADER
    for row, height in zip(rows, heights, strict=True):
        left = MARGIN
        for strip in row:
            figures += _draw_strip(canvas, strip, left, top)
            left += strip.width + STRIP_GAP
        top += height
    image = canvas.image()
    for left, top, strip, index in figures:
        posture = strip.postures[index]
        ground = posture.translation * [1.0, 1.0, 0.0] @ view_axes(strip.turn_rad, TILT_RAD)[:2].T
        center = (
            0.5 * strip.cell - SCALE * (ground[0] + strip.middle_m),
            strip.figure_height - FLOOR_HEIGHT + SCALE * ground[1],
        )
        tile = image[top : top + strip.figure_height, left : left + strip.cell]
        tile[:] = draw_mannequin(tile, body, posture, View(strip.turn_rad, TILT_RAD, SCALE, center))
    return image


def _draw_strip(canvas: Canvas, strip: _Strip, left: int, top: int) -> list[tuple[int, int, _Strip, int]]:
    """Draw a strip without its figures; returns left, top, strip and posture index of each figure."""
    _draw_section_title(canvas, strip, left, top)
    figures = []
    for first in range(0, len(strip.captions), strip.columns):
        shown = range(first, min(first + strip.columns, len(strip.captions)))
        y = top + SECTION + strip.row_height * (first // strip.columns)
        floor = backdrop(
            strip.figure_height, strip.cell * len(shown), strip.figure_height - FLOOR_HEIGHT, SCALE
        )
        canvas.paste(floor, left, y, floor.shape[1], strip.figure_height)
        for column, index in enumerate(shown):
            x = left + column * strip.cell
            _draw_caption(canvas, strip.captions[index], x, y + strip.figure_height, strip.cell)
            figures.append((x, y, strip, index))
    return figures


def _packed_rows(strips: Sequence[_Strip]) -> list[list[_Strip]]:
    """Rows of strips, filled in order as far as they fit."""
    rows: list[list[_Strip]] = []
    free_width = 0
    for strip in strips:
        if not rows or strip.width + STRIP_GAP > free_width:
            rows.append([])
            free_width = WIDTH + STRIP_GAP
        rows[-1].append(strip)
        free_width -= strip.width + STRIP_GAP
    return rows


def _strips(library: Library, body: Body) -> list[_Strip]:
    strips = []
    for motion in library.motions:
        postures = [library.by_name[step.posture] for step in motion.steps]
        times = [f"{step.time_s:.2f} s" for step in motion.steps]
        strips.append(_strip(body, motion.name, _detail(motion), motion.cyclic, postures, times))
    used = {step.posture for motion in library.motions for step in motion.steps}
    loose = [posture for posture in library.postures if posture.name not in used]
    if loose:
        title = "Postures in no motion" if library.motions else "Postures"
        tags = [", ".join(posture.tags) for posture in loose]
        strips.append(_strip(body, title, "in any order", False, loose, tags))
    return strips


def _strip(
    body: Body,
    title: str,
    detail: str,
    cyclic: bool,
    entries: Sequence[LibraryPosture],
    below: Sequence[str],
) -> _Strip:
    postures = Posture.stack([entry.posture for entry in entries])
    turn = best_view_turn(body, postures)
    flat = postures.translation * [1.0, 1.0, 0.0] @ view_axes(turn, TILT_RAD)[:2].T
    landmarks = projected_landmarks(body, postures, turn) - flat[:, None]
    left, right = float(landmarks[..., 0].min()) - FLESH_M, float(landmarks[..., 0].max()) + FLESH_M
    cell = int(np.clip(SCALE * (right - left) + 8, NARROWEST, WIDEST))
    figure_height = int(SCALE * (float(landmarks[..., 1].max()) + FLESH_M)) + 8 + FLOOR_HEIGHT
    captions = tuple(
        (ascii_text(_without_prefix(title, entry.name)), ascii_text(words))
        for entry, words in zip(entries, below, strict=True)
    )
    middle = 0.5 * (left + right)
    return _Strip(
        ascii_text(title),
        ascii_text(detail),
        cyclic,
        captions,
        postures,
        turn,
        middle,
        cell,
        max(figure_height, 60),
    )


def _without_prefix(title: str, name: str) -> str:
    """A posture's name without the motion's name and colon in front, which the strip's title says."""
    before, colon, rest = name.partition(":")
    return rest.strip() if colon and rest.strip() and before.casefold() == title.casefold() else name


def _detail(motion: LibraryMotion) -> str:
    x, y, heading = motion.travel
    words = [f"{'comes again after' if motion.cyclic else 'lasts'} {motion.duration_s:.2f} s"]
    if np.hypot(x, y) > 0.005:
        words.append(f"travels {np.hypot(x, y):.2f} m")
    if abs(heading) > 0.005:
        words.append(
            f"turns {abs(np.degrees(heading)):.0f} degrees to the {'left' if heading > 0 else 'right'}"
        )
    return ", ".join(words)


def _draw_header(canvas: Canvas, library: Library) -> None:
    canvas.text(ascii_text(library.title), MARGIN, 38.0, 17.0, INK)
    words = (
        f"{library.identifier}, version {library.version}   "
        f"{library.size}   "
        f"by {library.author}   {library.license}   figure of {library.actor.stature_m:.2f} m"
    )
    canvas.text(ascii_text(words), MARGIN, 58.0, 8.5, GRAY)
    canvas.text(
        truncated(ascii_text(library.description), canvas.width - 2 * MARGIN - 260.0, 8.5),
        MARGIN,
        76.0,
        8.5,
        GRAY,
    )
    sides: tuple[tuple[str, Color, bool], ...] = (("right, banded", RIGHT, True), ("left", LEFT, False))
    x = float(canvas.width - MARGIN)
    for word, color, banded in sides:
        canvas.text(word, x, 76.0, 8.5, GRAY, "right")
        x -= canvas.text_width(word, 8.5) + 8.0
        canvas.line([[x - 26.0, 72.0], [x, 72.0]], color, 7.0)
        if banded:
            canvas.line([[x - 14.0, 68.0], [x - 14.0, 76.0]], (235, 232, 230), 4.0)
        x -= 46.0


def _draw_section_title(canvas: Canvas, strip: _Strip, left: int, top: int) -> None:
    base = top + SECTION - 11.0
    canvas.text(strip.title, left, base, 11.0, INK)
    x = left + canvas.text_width(strip.title, 11.0) + 14.0
    if strip.cyclic:
        _draw_loop_sign(canvas, x + 7.0, base - 5.5)
        x += 22.0
    canvas.text(strip.detail, x, base, 8.5, GRAY)


def _draw_loop_sign(canvas: Canvas, x: float, y: float, radius: float = 6.0) -> None:
    """A circle that ends in an arrow, for a cyclic motion."""
    angle = np.linspace(-0.35 * np.pi, 1.35 * np.pi, 24)
    circle = np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=-1)
    canvas.line(circle, GRAY, 1.6)
    tip, back = circle[-1], circle[-1] - circle[-4]
    along = back / np.linalg.norm(back)
    across = np.array([-along[1], along[0]])
    canvas.polygon([tip + 5.0 * along, tip + 3.6 * across, tip - 3.6 * across], GRAY)


def _draw_caption(canvas: Canvas, caption: tuple[str, str], left: int, base: int, width: int) -> None:
    name, below = caption
    middle, y = left + 0.5 * width, base + 13.0
    for line in _name_lines(name, width):
        canvas.text(line, middle, y, LETTER_SIZE, INK, "middle")
        y += LINE_HEIGHT
    canvas.text(truncated(below, width - 8.0, 7.5), middle, y + 1.0, 7.5, GRAY, "middle")


def _name_lines(name: str, width: int) -> Sequence[str]:
    return wrapped(name, width - 10.0, LETTER_SIZE, MOST_LINES)
