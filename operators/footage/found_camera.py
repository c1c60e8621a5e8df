"""Lines drawn over the footage to find its camera: the state of the running tool, as a mouse changes it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.types import PropertyGroup

from ...core.arrays import Array
from ...core.camera.camera_evidence import CameraEvidence, Uprights
from ...core.camera.camera_fields import CameraPlacement
from ...core.errors import InputError
from ..bridge.footage import read_lens, write_placement
from ..shell.takes import footage_of
from .load_footage import lens_is_guess
from .properties import confirm_placement

if TYPE_CHECKING:
    import bpy

    from ...core.camera.camera_fit import CameraFit


VERTICAL, LEVEL, ACROSS, HEIGHT = KINDS = ("VERTICAL", "LEVEL", "ACROSS", "HEIGHT")
NEAR_PX = 12.0  # Distance in the region within which an end is taken [px at a UI scale of 1]
CLICKED_PX = 6.0  # Length below which a line is not drawn yet: its other end follows at the next click

Pixel = tuple[float, float]


@dataclass
class DrawnLine:
    """A line over the footage."""

    kind: str
    ends: list[Pixel]  # Both ends [px of the footage]
    frame: int  # Scene frame in which it was drawn
    length: float = 0.0  # Known length [m]; 0 for the performer's height


@dataclass
class Drawing:
    """The lines of a running tool."""

    kind: str  # Kind of the next line
    stays: bool  # Whether the kind stays the same after each line
    lines: list[DrawnLine] = field(default_factory=list)
    held: tuple[int, int] | None = None  # Index of the line whose end follows the mouse, and of that end
    last: int | None = None  # Index of the line that was drawn or moved last
    typed: str = ""  # Digits of a length that is being typed
    fit: "CameraFit | None" = None  # What the lines say of the camera; None before there is any
    stature_m: float = 0.0  # The performer's height [m]
    of_performer: bool = False  # Whether a length that is typed is the performer's height

    def press(self, pixel: Pixel, frame: int, near: Callable[[Pixel], float]) -> None:
        """Take the end of a line that is `near`, by shares of `NEAR_PX` in the region, or begin a line."""
        if self.held is not None:  # the second click of a line that is drawn by two
            self.move(pixel)
            return
        self.typed = ""
        ends = [
            (near(end), (number, which))
            for number, line in enumerate(self.lines)
            for which, end in enumerate(line.ends)
        ]
        nearest = min(ends, default=(np.inf, (0, 0)))
        if nearest[0] <= 1.0:
            self.held = nearest[1]
        else:
            self.lines.append(DrawnLine(self.kind, [pixel, pixel], frame))
            self.held = len(self.lines) - 1, 1
        self.last = self.held[0]

    def move(self, pixel: Pixel) -> None:
        if self.held is not None:
            number, which = self.held
            self.lines[number].ends[which] = pixel

    def release(self, far: Callable[[Pixel, Pixel], float]) -> bool:
        """Let go of the held end unless both are near, by shares of `CLICKED_PX`; return whether."""
        if self.held is None:
            return False
        line = self.lines[self.held[0]]
        if far(line.ends[0], line.ends[1]) < 1.0:
            return False
        is_new = self.held == (len(self.lines) - 1, 1) and line.kind == self.kind
        self.held = None
        drawn = sum(other.kind == self.kind for other in self.lines)
        if is_new and not self.stays and drawn >= 2 and self.kind in (VERTICAL, LEVEL):
            self.kind = LEVEL if self.kind == VERTICAL else HEIGHT
        return True

    def next_kind(self) -> None:
        self.kind, self.stays = KINDS[(KINDS.index(self.kind) + 1) % len(KINDS)], True

    def remove(self, near: Callable[[DrawnLine], float]) -> None:
        """Remove the line that is `near` the mouse, else the last one; a line that is being drawn first."""
        if not self.lines:
            return
        number = len(self.lines) - 1
        if self.held is None:
            shares = [near(line) for line in self.lines]
            if min(shares) <= 1.0:
                number = int(np.argmin(shares))
        self.lines.pop(number)
        self.held = self.last = None
        self.typed = ""

    def type(self, letter: str) -> bool:
        """Type a digit of the length of the line drawn last; return whether it is one with a length."""
        if self.last is None or self.lines[self.last].kind != HEIGHT:
            return False
        self.typed = self.typed[:-1] if letter == "\b" else self.typed + letter
        try:
            length = float(self.typed)
        except ValueError:  # nothing yet, or a point alone
            length = 0.0
        if not self.of_performer:
            self.lines[self.last].length = length
        elif 0.5 <= length <= 3.0:  # limits of a performer's height [m]
            self.stature_m = length
        return True

    def length_of(self, line: DrawnLine) -> float:
        """Known length of a line of that kind [m]."""
        return line.length or self.stature_m

    @property
    def complete(self) -> list[DrawnLine]:
        return [line for line in self.lines if line.ends[0] != line.ends[1]]


def read_lines(take: "bpy.types.PropertyGroup") -> list[DrawnLine]:
    """The lines that a take keeps."""
    return [
        DrawnLine(line.kind, [tuple(line.start), tuple(line.end)], line.frame, line.length)
        for line in take.camera_lines
    ]


def store_lines(take: "bpy.types.PropertyGroup", lines: list[DrawnLine]) -> None:
    """Keep lines with a take, so that they can be drawn on later."""
    take.camera_lines.clear()
    for line in lines:
        stored = take.camera_lines.add()
        stored.kind, stored.frame, stored.length = line.kind, line.frame, line.length
        stored.start, stored.end = line.ends


def evidence_of(lines: list[DrawnLine], stature_m: float) -> CameraEvidence:
    """What lines tell of the camera; the upper end of a known height is the higher one in the picture."""

    def ends(kind: str) -> Array:
        return np.array([line.ends for line in lines if line.kind == kind]).reshape(-1, 2, 2)

    def upright(known: bool) -> tuple[Array, Array]:
        chosen = [line for line in lines if line.kind == HEIGHT and (line.length > 0.0) == known]
        pairs = [sorted(line.ends, key=lambda pixel: -pixel[1]) for line in chosen]
        lower_and_upper = np.array(pairs).reshape(-1, 2, 2)
        return lower_and_upper[:, 0], lower_and_upper[:, 1]

    lengths = np.array([line.length for line in lines if line.kind == HEIGHT and line.length > 0.0])
    uprights = Uprights.persons(*upright(False), stature_m) + Uprights.things(*upright(True), lengths)
    return CameraEvidence(ends(VERTICAL), ends(LEVEL), ends(ACROSS), uprights)


_running: Drawing | None = None


def running() -> Drawing | None:
    """The running tool's drawing, for the overlays; None without one."""
    return _running


def show(drawing: Drawing | None) -> None:
    """Let the overlays draw these lines from now on; None ends the drawing."""
    global _running
    _running = drawing


HINTS = {
    "height": "Height is kept: draw something of known height, or the performer nearer and farther away",
    "tilt": "Tilt is kept: draw verticals farther apart, or the performer nearer and farther away",
    "roll": "Roll is kept: draw verticals, or the performer at both sides of the picture",
    "lens": "Lens is kept: level lines that run away from a tilted camera would tell it",
}
"""What would determine each part of the camera that a picture does not determine."""
MOST_EXCESS = 3.0
"""Ratio of the variance of the distances to the expected one beyond which lines contradict each other."""
NOTHING_FOUND = (
    "the picture says nothing of its camera yet; draw longer lines, farther apart, or a known height, or the "
    "performer at two places, nearer and farther away"
)
CONTRADICTION = "The lines are {px:.1f} px off: one of them is not what it is said to be, or lies wrong"


def is_found(fit: "CameraFit") -> bool:
    """Whether a picture determines anything of its camera."""
    return len(fit.kept) < len(fit.std)


def write_fit(take: PropertyGroup, fit: "CameraFit") -> None:
    """Give the take's camera what was found, and keep in words how sure it is."""
    if not is_found(fit):
        raise InputError(NOTHING_FOUND)
    lens_was_guess = lens_is_guess(take)
    # Where Blender measures the sensor along the other side, the same factor applies.
    take.camera.data.lens *= fit.camera.lens_mm / read_lens(footage_of(take.id_data, take)).lens_mm
    write_placement(take.camera, CameraPlacement.of(fit.camera.matrix_world))
    confirm_placement(take)
    if "lens" not in fit.kept:
        for other in take.id_data.keymark.takes:
            if other.camera == take.camera:
                other.guessed_lens_mm = 0.0
    take.camera_findings = "\n".join((deviations(fit), *doubts(fit, lens_was_guess)))


def values(fit: "CameraFit") -> str:
    """The camera found, with the deviations of what the picture determines."""
    kept = {name: " (kept)" if name in fit.kept else "" for name in HINTS}
    parts = (fit.in_words(name) + kept[name] for name in HINTS)
    return "   ".join(part[:1].upper() + part[1:] for part in parts)


def deviations(fit: "CameraFit") -> str:
    """The deviations alone, of what the picture determines."""
    from ...core.camera.camera_fit import UNITS

    found = (f"{name} ± {fit.spread(name)}{UNITS[name][1]}" for name in UNITS if name not in fit.kept)
    return f"Found: {', '.join(found)}"


def doubts(fit: "CameraFit", lens_is_guess: bool) -> list[str]:
    """Sentences on what was not found and how it would be, and on a contradiction."""
    open_ones = [name for name in HINTS if name in fit.kept and (name != "lens" or lens_is_guess)]
    sentences = [HINTS[name] for name in open_ones]
    if fit.excess > MOST_EXCESS:
        sentences.insert(0, CONTRADICTION.format(px=fit.misfit_px))
    return sentences
