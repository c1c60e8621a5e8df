"""A legend in the corner: a sample of each kind of line, and what it means."""

from dataclasses import dataclass, field

import bpy
import numpy as np
from bpy.app.translations import pgettext_iface
from numpy.typing import NDArray

from .drawing import text_size
from .figures import circles, dashes, diamonds, segments
from .picture import Fill, Item, Label, Stroke
from .style import CORE, DASH, DIAMOND, DOT, GAP, JOINT, LEFT, MIDDLE, RIGHT, Style

Array = NDArray[np.float64]

GROUND = (0.0, 0.0, 0.0, 0.35)
DOTS = 3
SAMPLE, LINE, MARGIN = 26.0, 18.0, 12.0
"""Length of a sample, height of a line, distance from the corner [px]."""
ABOVE_CACHE = 22.0
"""The Movie Clip editor draws its cached frames at the bottom [px]."""


@dataclass
class Legend:
    """Lines of a legend, from the bottom up."""

    x: float
    y: float
    style: Style
    items: list[Item] = field(default_factory=list)

    def solid(self, words: str, *, dotted: bool = False) -> None:
        """A solid line, with a dot a frame where it is a path."""
        self._line(words, self._sample(), dotted)

    def dashed(self, words: str, *, dotted: bool = False) -> None:
        """A dashed line, with a dot a frame where it is a path."""
        (line,) = self._sample()
        self._line(words, dashes(line, DASH * self.style.scale, GAP * self.style.scale), dotted)

    def limb(self, words: str, side: str) -> None:
        """A left limb's line, or a right one's."""
        line, style = self._sample(), self.style
        color = LEFT if side == "L" else RIGHT
        drawn: list[Item] = [Stroke(line, style.color(color), 3.6, style.halo)]
        if side == "R":
            drawn.append(Stroke(line, style.color(CORE), 1.6))
        self._row(words, drawn)

    def ring(self, words: str) -> None:
        """An uncertain point."""
        (rim,) = circles(self._middle(), JOINT * self.style.scale, 16)
        stroke = Stroke(segments(rim, closed=True), self.style.color(MIDDLE), 1.5, self.style.halo)
        self._row(words, [stroke])

    def diamond(self, words: str) -> None:
        """A keyframe."""
        marks = diamonds(self._middle(), DIAMOND * self.style.scale)
        color = self.style.color(MIDDLE)
        self._row(
            words, [Stroke(segments(marks, closed=True), color, 1.5, self.style.halo), Fill(marks, color)]
        )

    def sentence(self, words: str) -> None:
        """Words without a sample."""
        self.items.append(Label(words, self.x, self.y, self.style.color(MIDDLE)))
        self.y += LINE * self.style.scale

    def finished(self) -> list[Item]:
        """Everything, on a dark ground that sets it off from bright footage."""
        labels = [item for item in self.items if isinstance(item, Label)]
        if not labels:
            return []
        edge = 0.5 * MARGIN * self.style.scale
        right = max(label.x + text_size(label.words)[0] for label in labels) + edge
        left, bottom, top = self.x - edge, labels[0].y - edge, labels[-1].y + LINE * self.style.scale
        ground = np.array([[[left, bottom], [right, bottom], [right, top], [left, top]]])
        # Thick lines below thin ones, and each kind together: few calls draw them all.
        strokes = [item for item in self.items if isinstance(item, Stroke)]
        strokes.sort(key=lambda stroke: -stroke.width)
        fills = [item for item in self.items if isinstance(item, Fill)]
        return [Fill(ground, self.style.color(GROUND)), *strokes, *fills, *labels]

    def _line(self, words: str, parts: Array, dotted: bool) -> None:
        color, (ends,) = self.style.color(MIDDLE), self._sample()
        drawn: list[Item] = [Stroke(parts, color, 1.5, self.style.halo)]
        if dotted:
            dots = np.linspace(ends[0], ends[1], DOTS + 2)[1:-1]
            drawn.append(Fill(circles(dots, (DOT + 1.0) * self.style.scale, 8), color))
        self._row(words, drawn)

    def _row(self, words: str, sample: list[Item]) -> None:
        self.items += sample
        x = self.x + (SAMPLE + 8.0) * self.style.scale
        self.items.append(Label(pgettext_iface(words), x, self.y, self.style.color(MIDDLE)))
        self.y += LINE * self.style.scale

    def _middle(self) -> Array:
        return np.array([[self.x + 0.5 * SAMPLE * self.style.scale, self.y + 4.0 * self.style.scale]])

    def _sample(self) -> Array:
        y = self.y + 4.0 * self.style.scale
        return np.array([[[self.x, y], [self.x + SAMPLE * self.style.scale, y]]])


def corner(area: bpy.types.Area, region: bpy.types.Region, scale: float) -> tuple[float, float]:
    """The bottom left corner of what no toolbar covers of a region [region px]."""
    left = bottom = 0.0
    for other in area.regions:
        covers = other.width > 1 and other.height > 1 and other != region
        if covers and other.alignment == "LEFT":
            left = max(left, float(other.x + other.width - region.x))
        elif covers and other.alignment == "BOTTOM" and other.y <= region.y:
            bottom = max(bottom, float(other.y + other.height - region.y))
    lift = ABOVE_CACHE if area.type == "CLIP_EDITOR" else 0.0
    return left + MARGIN * scale, bottom + (MARGIN + lift) * scale
