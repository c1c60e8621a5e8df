"""A library on one sheet: every motion as a strip of its postures, then the postures that belong to none."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Image
from ..body.kinematics import Body
from ..body.posture import Posture
from ..library.library import Library, LibraryMotion, LibraryPosture
from .canvas import GRAY, INK, LEFT, RIGHT, Canvas, Color
from .captions import cut, plain, wrapped
from .mannequin import View, draw_mannequin, view_axes
from .posture_picture import FLESH_M, TILT_RAD, outermost, showing_turn, stage

MARGIN = 28
LEAST_WIDTH, WIDTH = 900, 1520
"""Of what lies between the margins, at least and at most."""
SCALE = 86.0
"""Pixels a meter, the same for every figure."""
NARROWEST, WIDEST = 98, 230
"""Width of a cell."""
HEADER, SECTION = 96, 34
BETWEEN, BELOW = 40, 22
"""Space between two strips side by side, and below them."""
FLOOR_ROOM = 22
"""Height below the floor's middle, where the nearer foot is."""
LETTER, LINE, MOST_LINES = 8.0, 11.5, 3


@dataclass(frozen=True)
class _Strip:
    """Postures that are shown side by side from one direction."""

    title: str
    detail: str
    cyclic: bool
    captions: tuple[tuple[str, str], ...]
    """Name and time of each."""
    postures: Posture
    """A batch."""
    turn_rad: float
    middle_m: float
    """What stands in the middle of a cell, so far to the right of the hips."""
    cell: int
    """Width of what one posture takes."""
    high: int
    """Height of the stage."""

    @property
    def columns(self) -> int:
        """Postures in a row; where one row is too short for all they are divided evenly."""
        rows = -(-len(self.captions) * self.cell // WIDTH)
        return -(-len(self.captions) // rows)

    @property
    def lines(self) -> int:
        """Lines of the longest name."""
        return max(len(_name_lines(name, self.cell)) for name, _ in self.captions)

    @property
    def row(self) -> int:
        """Height of a row with what is written below."""
        return self.high + round(LINE * (self.lines + 1)) + 12

    @property
    def height(self) -> int:
        """Height of the whole strip."""
        return SECTION + self.row * -(-len(self.captions) // self.columns)

    @property
    def width(self) -> int:
        """Width of the whole strip, its title included."""
        words = Canvas.text_width(self.title, 11.0) + Canvas.text_width(self.detail, 8.5) + 40.0
        return max(self.columns * self.cell, min(int(words), WIDTH))


def library_sheet(library: Library) -> Image:
    """Draw every posture of a library with its name and time, each motion a strip.

    Returns:
        (height, width, 3) blue, green, red.
    """
    body = Body(library.actor)
    shelves = _packed(_strips(library, body))
    heights = [max(strip.height for strip in shelf) + BELOW for shelf in shelves]
    widest = max(sum(strip.width + BETWEEN for strip in shelf) - BETWEEN for shelf in shelves)
    canvas = Canvas(max(widest, LEAST_WIDTH) + 2 * MARGIN, HEADER + sum(heights))
    _header(canvas, library)
    figures: list[tuple[int, int, _Strip, int]] = []
    top = HEADER
    for shelf, height in zip(shelves, heights, strict=True):
        left = MARGIN
        for strip in shelf:
            figures += _lay(canvas, strip, left, top)
            left += strip.width + BETWEEN
        top += height
    image = canvas.image()
    for left, top, strip, index in figures:
        posture = strip.postures[index]
        ground = posture.translation * [1.0, 1.0, 0.0] @ view_axes(strip.turn_rad, TILT_RAD)[:2].T
        center = (
            0.5 * strip.cell - SCALE * (ground[0] + strip.middle_m),
            strip.high - FLOOR_ROOM + SCALE * ground[1],
        )
        tile = image[top : top + strip.high, left : left + strip.cell]
        tile[:] = draw_mannequin(tile, body, posture, View(strip.turn_rad, TILT_RAD, SCALE, center))
    return image


def _lay(canvas: Canvas, strip: _Strip, left: int, top: int) -> list[tuple[int, int, _Strip, int]]:
    """Draw a strip without its figures; where these go: left, top, strip, and which of its postures."""
    _section(canvas, strip, left, top)
    figures = []
    for first in range(0, len(strip.captions), strip.columns):
        shown = range(first, min(first + strip.columns, len(strip.captions)))
        y = top + SECTION + strip.row * (first // strip.columns)
        floor = stage(strip.high, strip.cell * len(shown), strip.high - FLOOR_ROOM, SCALE)
        canvas.paste(floor, left, y, floor.shape[1], strip.high)
        for place, index in enumerate(shown):
            x = left + place * strip.cell
            _caption(canvas, strip.captions[index], x, y + strip.high, strip.cell)
            figures.append((x, y, strip, index))
    return figures


def _packed(strips: Sequence[_Strip]) -> list[list[_Strip]]:
    """Strips side by side as long as they fit, in their order."""
    shelves: list[list[_Strip]] = []
    room = 0
    for strip in strips:
        if not shelves or strip.width + BETWEEN > room:
            shelves.append([])
            room = WIDTH + BETWEEN
        shelves[-1].append(strip)
        room -= strip.width + BETWEEN
    return shelves


def _strips(library: Library, body: Body) -> list[_Strip]:
    strips = []
    for motion in library.motions:
        postures = [library.by_name[step.posture] for step in motion.steps]
        times = [f"{step.time_s:.2f} s" for step in motion.steps]
        strips.append(_strip(body, motion.name, _detail(motion), motion.cyclic, postures, times))
    placed = {step.posture for motion in library.motions for step in motion.steps}
    loose = [posture for posture in library.postures if posture.name not in placed]
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
    turn = showing_turn(body, postures)
    flat = postures.translation * [1.0, 1.0, 0.0] @ view_axes(turn, TILT_RAD)[:2].T
    seen = outermost(body, postures, turn) - flat[:, None]
    left, right = float(seen[..., 0].min()) - FLESH_M, float(seen[..., 0].max()) + FLESH_M
    cell = int(np.clip(SCALE * (right - left) + 8, NARROWEST, WIDEST))
    high = int(SCALE * (float(seen[..., 1].max()) + FLESH_M)) + 8 + FLOOR_ROOM
    captions = tuple(
        (plain(_within(title, entry.name)), plain(words)) for entry, words in zip(entries, below, strict=True)
    )
    middle = 0.5 * (left + right)
    return _Strip(plain(title), plain(detail), cyclic, captions, postures, turn, middle, cell, max(high, 60))


def _within(title: str, name: str) -> str:
    """A posture's name in the strip of a motion: without the motion's name before a colon."""
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


def _header(canvas: Canvas, library: Library) -> None:
    canvas.text(plain(library.title), MARGIN, 38.0, 17.0, INK)
    words = (
        f"{library.identifier}, version {library.version}   "
        f"{library.size}   "
        f"by {library.author}   {library.license}   figure of {library.actor.stature_m:.2f} m"
    )
    canvas.text(plain(words), MARGIN, 58.0, 8.5, GRAY)
    canvas.text(
        cut(plain(library.description), canvas.width - 2 * MARGIN - 260.0, 8.5), MARGIN, 76.0, 8.5, GRAY
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


def _section(canvas: Canvas, strip: _Strip, left: int, top: int) -> None:
    base = top + SECTION - 11.0
    canvas.text(strip.title, left, base, 11.0, INK)
    x = left + canvas.text_width(strip.title, 11.0) + 14.0
    if strip.cyclic:
        _loop(canvas, x + 7.0, base - 5.5)
        x += 22.0
    canvas.text(strip.detail, x, base, 8.5, GRAY)


def _loop(canvas: Canvas, x: float, y: float, radius: float = 6.0) -> None:
    """A circle that ends in an arrow: what comes again."""
    angle = np.linspace(-0.35 * np.pi, 1.35 * np.pi, 24)
    circle = np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=-1)
    canvas.line(circle, GRAY, 1.6)
    tip, back = circle[-1], circle[-1] - circle[-4]
    along = back / np.linalg.norm(back)
    across = np.array([-along[1], along[0]])
    canvas.polygon([tip + 5.0 * along, tip + 3.6 * across, tip - 3.6 * across], GRAY)


def _caption(canvas: Canvas, caption: tuple[str, str], left: int, base: int, width: int) -> None:
    name, below = caption
    middle, y = left + 0.5 * width, base + 13.0
    for line in _name_lines(name, width):
        canvas.text(line, middle, y, LETTER, INK, "middle")
        y += LINE
    canvas.text(cut(below, width - 8.0, 7.5), middle, y + 1.0, 7.5, GRAY, "middle")


def _name_lines(name: str, width: int) -> Sequence[str]:
    return wrapped(name, width - 10.0, LETTER, MOST_LINES)
