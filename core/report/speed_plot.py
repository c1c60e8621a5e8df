"""The sum of speeds in the image over the clip with the keyframes circled: the paper's Figure 5."""

from collections.abc import Collection

import numpy as np

from ..arrays import Array, Image
from .axes import Axes
from .canvas import ACCENT, INK, LEFT, Canvas, ticks

WIDTH, HEIGHT = 1200, 420


def speed_plot(speed: Array, keyframe_indices: Collection[int], frame_start: int) -> Image:
    """Plot V_sum over the frames.

    Args:
        speed: (F,) V_sum, the sum of the speeds of what is followed [px/frame] (paper, eq. 8); NaN breaks the
            curve.
        keyframe_indices: Frame indices of the keyframes.
        frame_start: Scene frame of index 0.

    Returns:
        (height, width, 3) picture.
    """
    canvas = Canvas(WIDTH, HEIGHT)
    known = speed[np.isfinite(speed)]
    levels = ticks(0.0, max(float(known.max(initial=0.0)), 1e-3) * 1.05, 7)
    top = max(float(known.max(initial=0.0)) * 1.08, levels[-1], 1e-3)
    last = frame_start + max(len(speed) - 1, 1)
    axes = Axes(canvas, (frame_start, last), top)
    axes.draw(ticks(frame_start, last, 14), levels)
    curve = np.array([axes.to_canvas(frame_start + index, value) for index, value in enumerate(speed)])
    canvas.line(curve.reshape(-1, 2), LEFT, 1.6)
    for index in sorted(keyframe_indices):
        value = float(speed[index]) if np.isfinite(speed[index]) else 0.0
        _mark_keyframe(canvas, axes.to_canvas(frame_start + index, value), axes.floor)
    axes.label("Speed in the image over the clip", "scene frame", "sum of speeds [px/frame]")
    _draw_legend(canvas, axes.right)
    return canvas.image()


def _mark_keyframe(canvas: Canvas, at: tuple[float, float], floor: float) -> None:
    canvas.dashed([at[0], at[1] + 8.0], [at[0], floor], ACCENT)
    canvas.disc(at, 6.0, (255, 255, 255))
    canvas.ring(at, 6.0, ACCENT, 1.8)
    canvas.disc(at, 1.8, LEFT)


def _draw_legend(canvas: Canvas, right: float) -> None:
    canvas.text("keyframe", right, 31.0, 9.0, INK, "right")
    at = right - canvas.text_width("keyframe") - 14.0
    canvas.ring([at, 26.5], 6.0, ACCENT, 1.8)
    canvas.disc([at, 26.5], 1.8, LEFT)
