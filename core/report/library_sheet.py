"""A library on one sheet: every motion as a strip of its postures, then the postures that belong to none."""

import textwrap
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..body.kinematics import Body
from ..body.posture import Posture
from ..library.library import Library, LibraryMotion
from .canvas import GREY, INK, LEFT, RIGHT, Canvas, Color, Image
from .mannequin import View, draw_mannequin, view_axes
from .posture_picture import FLESH_M, TILT_RAD, outermost, showing_turn, stage

Array = NDArray[np.float64]

MARGIN = 28
LEAST_COLUMNS, MOST_COLUMNS = 8, 12
SCALE = 92.0
"""Pixels a metre, the same for every figure."""
NARROWEST, WIDEST = 112, 210
"""Width of a cell."""
HEADER, SECTION, LABELS, GAP = 96, 34, 62, 14
FLOOR_ROOM = 22
"""Height below the floor's middle, where the nearer foot is."""
LETTER = 8.0


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


def library_sheet(library: Library) -> Image:
    """Draw every posture of a library with its name and time, motions in rows.

    Returns:
        (height, width, 3) blue, green, red.
    """
    body = Body(library.actor)
    strips = _strips(library, body)
    seen = [outermost(body, strip.postures, strip.turn_rad) - _ground(strip)[:, None] for strip in strips]
    reach = max(float(np.abs(places[..., 0]).max()) for places in seen) + FLESH_M
    cell = int(np.clip(2.0 * SCALE * reach, NARROWEST, WIDEST))
    tall = [int(SCALE * (float(places[..., 1].max()) + FLESH_M)) + 8 + FLOOR_ROOM for places in seen]
    rows = [-(-len(strip.captions) // MOST_COLUMNS) for strip in strips]
    columns = [-(-len(strip.captions) // row) for strip, row in zip(strips, rows, strict=True)]
    width = 2 * MARGIN + max(*columns, LEAST_COLUMNS) * cell
    height = HEADER + sum(SECTION + row * (high + LABELS) + GAP for row, high in zip(rows, tall, strict=True))
    canvas = Canvas(width, height)
    _header(canvas, library)
    figures: list[tuple[int, int, int, Posture, float]] = []
    top = HEADER
    for strip, high, across in zip(strips, tall, columns, strict=True):
        _section(canvas, strip, top)
        top += SECTION
        for first in range(0, len(strip.captions), across):
            shown = range(first, min(first + across, len(strip.captions)))
            floor = stage(high, cell * len(shown), high - FLOOR_ROOM, SCALE)
            canvas.paste(floor, MARGIN, top, floor.shape[1], high)
            for place, index in enumerate(shown):
                left = MARGIN + place * cell
                _caption(canvas, strip.captions[index], left, top + high, cell)
                figures.append((left, top, high, strip.postures[index], strip.turn_rad))
            top += high + LABELS
        top += GAP
    image = canvas.image()
    for left, top, high, posture, turn in figures:
        ground = posture.translation * [1.0, 1.0, 0.0] @ view_axes(turn, TILT_RAD)[:2].T
        centre = (0.5 * cell - SCALE * ground[0], high - FLOOR_ROOM + SCALE * ground[1])
        tile = image[top : top + high, left : left + cell]
        tile[:] = draw_mannequin(tile, body, posture, View(turn, TILT_RAD, SCALE, centre))
    return image


def _strips(library: Library, body: Body) -> list[_Strip]:
    strips = []
    for motion in library.motions:
        postures = Posture.stack([library.by_name[step.posture].posture for step in motion.steps])
        captions = tuple((step.posture, f"{step.time_s:.2f} s") for step in motion.steps)
        strips.append(
            _Strip(
                motion.name, _detail(motion), motion.cyclic, captions, postures, showing_turn(body, postures)
            )
        )
    placed = {step.posture for motion in library.motions for step in motion.steps}
    loose = [posture for posture in library.postures if posture.name not in placed]
    if loose:
        postures = Posture.stack([posture.posture for posture in loose])
        captions = tuple((posture.name, ", ".join(posture.tags)) for posture in loose)
        title = "Postures in no motion" if library.motions else "Postures"
        strips.append(_Strip(title, "in any order", False, captions, postures, showing_turn(body, postures)))
    return strips


def _ground(strip: _Strip) -> Array:
    """(K, 2) where the floor under each figure's hips lies in the view [m]."""
    flat = strip.postures.translation * [1.0, 1.0, 0.0]
    return np.asarray(flat @ view_axes(strip.turn_rad, TILT_RAD)[:2].T)


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
    canvas.text(_plain(library.title), MARGIN, 38.0, 17.0, INK)
    words = (
        f"{library.identifier}, version {library.version}   "
        f"{len(library.postures)} postures, {len(library.motions)} motions   "
        f"by {library.author}   {library.license}   figure of {library.actor.stature_m:.2f} m"
    )
    canvas.text(_plain(words), MARGIN, 58.0, 8.5, GREY)
    canvas.text(_cut(_plain(library.description), canvas.width - 2 * MARGIN - 260.0), MARGIN, 76.0, 8.5, GREY)
    sides: tuple[tuple[str, Color, bool], ...] = (("right, banded", RIGHT, True), ("left", LEFT, False))
    x = float(canvas.width - MARGIN)
    for word, color, banded in sides:
        canvas.text(word, x, 76.0, 8.5, GREY, "right")
        x -= canvas.text_width(word, 8.5) + 8.0
        canvas.line([[x - 26.0, 72.0], [x, 72.0]], color, 7.0)
        if banded:
            canvas.line([[x - 14.0, 68.0], [x - 14.0, 76.0]], (235, 232, 230), 4.0)
        x -= 46.0


def _section(canvas: Canvas, strip: _Strip, top: int) -> None:
    base = top + SECTION - 11.0
    title = _plain(strip.title)
    canvas.text(title, MARGIN, base, 11.0, INK)
    x = MARGIN + canvas.text_width(title, 11.0) + 16.0
    if strip.cyclic:
        _loop(canvas, x + 7.0, base - 5.5)
        x += 22.0
    canvas.text(_plain(strip.detail), x, base, 8.5, GREY)


def _loop(canvas: Canvas, x: float, y: float, radius: float = 6.0) -> None:
    """A circle that ends in an arrow: what comes again."""
    angle = np.linspace(-0.35 * np.pi, 1.35 * np.pi, 24)
    circle = np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=-1)
    canvas.line(circle, GREY, 1.6)
    tip, back = circle[-1], circle[-1] - circle[-4]
    along = back / np.linalg.norm(back)
    across = np.array([-along[1], along[0]])
    canvas.polygon([tip + 5.0 * along, tip + 3.6 * across, tip - 3.6 * across], GREY)


def _caption(canvas: Canvas, caption: tuple[str, str], left: int, base: int, width: int) -> None:
    name, time = caption
    middle = left + 0.5 * width
    letters = max(int((width - 10) / canvas.text_width("n", LETTER)), 8)
    line_y = base + 13.0
    for line in _wrapped(_plain(name), letters):
        canvas.text(line, middle, line_y, LETTER, INK, "middle")
        line_y += 11.5
    canvas.text(_cut(_plain(time), width - 8.0), middle, line_y + 1.0, 7.5, GREY, "middle")


def _wrapped(text: str, letters: int) -> Sequence[str]:
    lines = textwrap.wrap(text, letters) or [""]
    return lines if len(lines) <= 3 else [*lines[:2], lines[2][: letters - 3] + "..."]


def _cut(text: str, width: float) -> str:
    if Canvas.text_width(text, 8.5) <= width:
        return text
    while text and Canvas.text_width(text + "...", 8.5) > width:
        text = text[:-1]
    return text.rstrip() + "..."


def _plain(text: str) -> str:
    """The text in the letters that can be drawn."""
    return unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
