"""A small square picture of a motion for an asset browser: three of its poses side by side."""

import numpy as np

from ..arrays import Array, Image
from ..take.motion import Motion
from .canvas import GRAY, Canvas
from .stick_figure import draw_figure, stick_figure

SIZE = 256
PAPER = (250, 249, 248)
POSES = 3
TURN_RAD = 0.5
"""Turn of the view from the performer's front, from where limbs show best."""
EDGE = 14
LIMB_WIDTH = 5.0


def thumbnail(motion: Motion) -> Image:
    """Draw three poses of a motion, the earliest at the left, in parallel projection.

    Args:
        motion: The motion, F frames.

    Returns:
        (256, 256, 3) blue, green, red.
    """
    frames = np.round(np.linspace(0, len(motion.time_s) - 1, 2 * POSES + 1)[1::2]).astype(np.intp)
    figure = stick_figure(motion)
    axes = _axes(motion)
    points = np.concatenate([limb.points for limb in figure.limbs], axis=1)[frames]  # (K, N, 3)
    seen = points @ axes.T
    middle = 0.5 * (seen[..., 0].max(axis=1) + seen[..., 0].min(axis=1))  # (K,)
    floor, top = seen[..., 1].min(), seen[..., 1].max() + figure.head_radius_m
    wide = float(np.ptp(seen[..., 0], axis=1).max())
    column = (SIZE - 2 * EDGE) / POSES
    scale = min((SIZE - 2 * EDGE) / (top - floor), 1.25 * column / wide)
    ground = 0.5 * (SIZE + scale * (top - floor))
    canvas = Canvas(SIZE, SIZE, PAPER)
    canvas.line([[EDGE, ground], [SIZE - EDGE, ground]], GRAY, 1.5)
    for number, frame in enumerate(frames):
        center = EDGE + column * (number + 0.5)

        def project(points: Array, center: float = center, number: int = number) -> tuple[Array, Array]:
            right, upward, away = axes @ points.T
            x, y = center + scale * (right - middle[number]), ground - scale * (upward - floor)
            return np.stack([x, y], axis=-1), away

        draw_figure(canvas, figure, int(frame), project, LIMB_WIDTH, outlined=True)
    return canvas.image()


def _axes(motion: Motion) -> Array:
    """World directions (3, 3) to the right, upwards, and away from the eye, as rows."""
    names = motion.body.skeleton.point_names
    side = (motion.points[:, names.index("hip.L")] - motion.points[:, names.index("hip.R")]).mean(axis=0)
    angle = float(np.arctan2(side[1], side[0])) + TURN_RAD  # the performer's left is on the right of the view
    right = np.array([np.cos(angle), np.sin(angle), 0.0])
    return np.stack([right, [0.0, 0.0, 1.0], [-right[1], right[0], 0.0]])
