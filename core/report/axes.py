"""The axes of a plot: scales from values to the canvas, ticks and labels."""

from collections.abc import Sequence

import numpy as np

from .canvas import GRAY, INK, PALE, Canvas

LEFT_EDGE, RIGHT_EDGE, UPPER_EDGE, LOWER_EDGE = 72, 24, 54, 52


class Axes:
    """A plot that fills a canvas: x runs to the right between two values, y upwards from zero."""

    def __init__(
        self, canvas: Canvas, x_range: tuple[float, float], top: float, *, logarithmic: bool = False
    ) -> None:
        """Lay the axes out.

        Args:
            canvas: The canvas to draw on.
            x_range: Values at the left and the right end of the x axis.
            top: Value at the upper end of the y axis.
            logarithmic: Whether the x axis is logarithmic.
        """
        self.canvas, self.top = canvas, top
        self.right, self.floor = canvas.width - RIGHT_EDGE, canvas.height - LOWER_EDGE
        self._logarithmic = logarithmic
        self._first, self._last = (self._x_scale(x) for x in x_range)

    def to_canvas(self, x: float, y: float) -> tuple[float, float]:
        """Point of the canvas for a pair of values."""
        share = (self._x_scale(x) - self._first) / (self._last - self._first)
        canvas_x = LEFT_EDGE + share * (self.right - LEFT_EDGE)
        return canvas_x, self.floor - y / self.top * (self.floor - UPPER_EDGE)

    def draw(self, x_ticks: Sequence[float], y_ticks: Sequence[float]) -> None:
        """Draw the axes, a pale line at every tick of y, and the ticks' values."""
        canvas, right, floor = self.canvas, self.right, self.floor
        for level in y_ticks:
            y = self.to_canvas(x_ticks[0], level)[1]
            canvas.line([[LEFT_EDGE, y], [right, y]], PALE)
            canvas.text(f"{level:g}", LEFT_EDGE - 9.0, y + 4.0, 9.0, INK, "right")
        for tick in x_ticks:
            x = self.to_canvas(tick, 0.0)[0]
            canvas.line([[x, floor], [x, floor + 5.0]], GRAY)
            canvas.text(f"{tick:g}", x, floor + 19.0, 9.0, INK, "middle")
        canvas.line([[LEFT_EDGE, UPPER_EDGE], [LEFT_EDGE, floor], [right, floor]], GRAY, 1.2)

    def label(self, title: str, x_title: str, y_title: str) -> None:
        """Write the title of the plot and those of its axes."""
        self.canvas.text(title, 16.0, 31.0, 12.0, INK)
        self.canvas.text(x_title, 0.5 * (LEFT_EDGE + self.right), self.floor + 40.0, 9.0, INK, "middle")
        self.canvas.vertical_text(y_title, 26.0, 0.5 * (UPPER_EDGE + self.floor), 9.0, INK)

    def _x_scale(self, x: float) -> float:
        return float(np.log(x)) if self._logarithmic else float(x)
