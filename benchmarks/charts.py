"""Charts of curves over an axis and of pairs of values in rows, in the style of the project's report."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from takes import OUTPUT, load_project

load_project()

from keymark.core.arrays import Array  # noqa: E402
from keymark.core.report.axes import Axes  # noqa: E402
from keymark.core.report.canvas import (  # noqa: E402
    ACCENT,
    GRAY,
    INK,
    LEFT,
    PALE,
    RIGHT,
    WHITE,
    Canvas,
    Color,
    ticks,
    write_png,
)

WIDTH, HEIGHT = 1200, 520
ROW, ROW_NAMES = 24, 330
COLORS = {"interpolation": GRAY, "ekf": RIGHT, "map": LEFT}
"""Color of each method, the same in all charts."""


@dataclass(frozen=True, eq=False)
class Curve:
    """Values y (N,) over x (N,)."""

    name: str
    """Name in the legend; empty for none."""
    x: Array
    y: Array
    color: Color
    points: str = ""
    """Marks of the values: `full`, `hollow`, or empty for none."""
    thickness: float = 2.0


@dataclass(frozen=True)
class Labels:
    """Titles of a chart and its axes."""

    title: str
    x: str
    y: str


@dataclass(frozen=True)
class Pair:
    """A row of two values."""

    name: str
    first: float
    second: float


def draw_chart(
    name: str,
    labels: Labels,
    curves: Sequence[Curve],
    *,
    level: float | None = None,
    marks: Sequence[float] = (),
    x_ticks: Sequence[float] | None = None,
) -> None:
    """Draw curves into out/bench.

    Args:
        name: The file's name without its ending.
        labels: Title and axes.
        curves: What to draw, the last uppermost.
        level: A y marked by a dashed line, such as an aim.
        marks: Values of x marked by dashed lines.
        x_ticks: Labeled values of a logarithmic x axis; a linear axis where None.
    """
    canvas = Canvas(WIDTH, HEIGHT)
    first = min(float(curve.x.min()) for curve in curves)
    last = max(float(curve.x.max()) for curve in curves)
    highest = max(float(np.nanmax(curve.y)) for curve in curves)
    top = 1.06 * max(highest, level or 0.0, 1e-3)
    axes = Axes(canvas, (first, last), top, logarithmic=x_ticks is not None)
    named = ticks(first, last, 14) if x_ticks is None else [x for x in x_ticks if first <= x <= last]
    axes.draw(named, ticks(0.0, top, 9))
    for x in marks:
        canvas.dashed(axes.to_canvas(x, 0.0), axes.to_canvas(x, top), PALE)
    if level is not None:
        canvas.dashed(axes.to_canvas(first, level), axes.to_canvas(last, level), ACCENT)
    for curve in curves:
        _draw(axes, curve)
    axes.label(labels.title, labels.x, labels.y)
    _legend(axes, [curve for curve in curves if curve.name])
    _write(name, canvas)


def draw_pairs(name: str, title: str, methods: tuple[str, str], pairs: Sequence[Pair]) -> None:
    """Draw rows of two methods' values into out/bench, with a dashed line where the first row's second is."""
    upper, right = 54.0, WIDTH - 24.0
    canvas = Canvas(WIDTH, round(upper) + ROW * len(pairs) + 40)
    highest = max(max(pair.first, pair.second) for pair in pairs)
    floor = upper + ROW * len(pairs)

    def across(value: float) -> float:
        return ROW_NAMES + value / (1.03 * highest) * (right - ROW_NAMES)

    for tick in ticks(0.0, highest, 12):
        canvas.line([[across(tick), upper], [across(tick), floor]], PALE)
        canvas.text(f"{tick:g}", across(tick), floor + 18.0, 9.0, INK, "middle")
    canvas.dashed([across(pairs[0].second), upper], [across(pairs[0].second), floor], ACCENT)
    for row, pair in enumerate(pairs):
        y = upper + ROW * (row + 0.5)
        canvas.text(pair.name, ROW_NAMES - 12.0, y + 4.0, 9.0, INK, "right")
        canvas.line([[across(pair.first), y], [across(pair.second), y]], GRAY)
        for method, value in zip(methods, (pair.first, pair.second), strict=True):
            canvas.disc([across(value), y], 5.0, COLORS[method])
    canvas.text(title, 16.0, 31.0, 12.0, INK)
    for place, method in zip((right - 220.0, right - 60.0), methods, strict=True):
        canvas.disc([place - 12.0, 26.5], 5.0, COLORS[method])
        canvas.text(method, place, 31.0, 9.0, INK)
    _write(name, canvas)


def _write(name: str, canvas: Canvas) -> None:
    OUTPUT.mkdir(parents=True, exist_ok=True)
    write_png(str(OUTPUT / f"{name}.png"), canvas.image())


def _draw(axes: Axes, curve: Curve) -> None:
    places = [axes.to_canvas(x, y) for x, y in zip(curve.x, curve.y, strict=True)]
    axes.canvas.line(places, curve.color, curve.thickness)
    if curve.points:
        for place in places:
            _point(axes.canvas, place, curve)


def _point(canvas: Canvas, place: tuple[float, float], curve: Curve) -> None:
    canvas.disc(place, 4.5, curve.color)
    if curve.points == "hollow":
        canvas.disc(place, 2.7, WHITE)


def _legend(axes: Axes, curves: Sequence[Curve]) -> None:
    right, y = axes.right, 31.0
    for curve in reversed(curves):
        axes.canvas.text(curve.name, right, y, 9.0, INK, "right")
        right -= axes.canvas.text_width(curve.name) + 8.0
        axes.canvas.line([[right - 28.0, y - 4.5], [right, y - 4.5]], curve.color, curve.thickness)
        if curve.points:
            _point(axes.canvas, (right - 14.0, y - 4.5), curve)
        right -= 28.0 + 20.0
