"""The sum of the markers' speeds over the clip with the keyframes circled: the paper's Figure 5."""

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from .canvas import ACCENT, GREY, INK, LEFT, PALE, Canvas, Image, ticks

Array = NDArray[np.float64]

WIDTH, HEIGHT = 1200, 420
LEFT_EDGE, RIGHT_EDGE, UPPER_EDGE, LOWER_EDGE = 72, 24, 54, 52


def speed_plot(speed: Array, keyframe_indices: Collection[int], frame_start: int) -> Image:
    """Plot V_sum over the frames.

    Args:
        speed: (F,) sum over the markers of their centroids' speeds [px/frame] (paper, eq. 8); NaN breaks
            the curve.
        keyframe_indices: Positions in the clip that are keyframes.
        frame_start: Scene frame of position 0.

    Returns:
        (height, width, 3) picture.
    """
    canvas = Canvas(WIDTH, HEIGHT)
    right, floor = WIDTH - RIGHT_EDGE, HEIGHT - LOWER_EDGE
    known = speed[np.isfinite(speed)]
    levels = ticks(0.0, max(float(known.max(initial=0.0)), 1e-3) * 1.05, 7)
    top = max(float(known.max(initial=0.0)) * 1.08, levels[-1], 1e-3)
    last = max(len(speed) - 1, 1)

    def place(index: float, value: float) -> tuple[float, float]:
        share = index / last
        return LEFT_EDGE + share * (right - LEFT_EDGE), floor - value / top * (floor - UPPER_EDGE)

    for level in levels:
        y = place(0.0, level)[1]
        canvas.line([[LEFT_EDGE, y], [right, y]], PALE)
        canvas.text(f"{level:g}", LEFT_EDGE - 9.0, y + 4.0, 9.0, INK, "right")
    for frame in ticks(frame_start, frame_start + last, 14):
        x = place(frame - frame_start, 0.0)[0]
        canvas.line([[x, floor], [x, floor + 5.0]], GREY)
        canvas.text(f"{frame:g}", x, floor + 19.0, 9.0, INK, "middle")
    canvas.line([[LEFT_EDGE, UPPER_EDGE], [LEFT_EDGE, floor], [right, floor]], GREY, 1.2)
    curve = np.array([place(index, value) for index, value in enumerate(speed)]).reshape(-1, 2)
    canvas.line(curve, LEFT, 1.6)
    for index in sorted(keyframe_indices):
        value = float(speed[index]) if np.isfinite(speed[index]) else 0.0
        _mark_keyframe(canvas, place(index, value), floor)
    _title(canvas, right, floor)
    return canvas.image()


def _mark_keyframe(canvas: Canvas, at: tuple[float, float], floor: float) -> None:
    canvas.dashed([at[0], at[1] + 8.0], [at[0], floor], ACCENT)
    canvas.disc(at, 6.0, (255, 255, 255))
    canvas.ring(at, 6.0, ACCENT, 1.8)
    canvas.disc(at, 1.8, LEFT)


def _title(canvas: Canvas, right: float, floor: float) -> None:
    canvas.text("Speed of the markers over the clip", 16.0, 31.0, 12.0, INK)
    canvas.text("keyframe", right, 31.0, 9.0, INK, "right")
    at = right - canvas.text_width("keyframe") - 14.0
    canvas.ring([at, 26.5], 6.0, ACCENT, 1.8)
    canvas.disc([at, 26.5], 1.8, LEFT)
    canvas.text("scene frame", 0.5 * (LEFT_EDGE + right), floor + 40.0, 9.0, INK, "middle")
    canvas.vertical_text("sum of speeds [px/frame]", 26.0, 0.5 * (UPPER_EDGE + floor), 9.0, INK)
