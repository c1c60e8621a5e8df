"""The pictures of a listing among extensions: icon and featured image.

Both show the demonstration: its footage, and the motion that a few posed keyframes make of it. A listing
wants an icon of 256 by 256 pixels and a featured image of 1920 by 1080.
"""

from pathlib import Path

import numpy as np
from keymark.core.api import reconstruct
from keymark.core.arrays import Array, Image
from keymark.core.progress import run
from keymark.core.report.canvas import (
    INK,
    WHITE,
    Canvas,
    Color,
    View,
    draw_figure,
    stick_figure,
    view_axes,
    write_png,
)
from keymark.core.report.mannequin import TILT_RAD, backdrop, draw_mannequin, mannequin
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.core.video.clip import Clip

from .results import Results
from .writing import write_picture

SLOGAN = "one video, a few keyframes, any character"

NIGHT: Color = (48, 38, 33)
CLOTH: Color = (104, 94, 86)
BLUE: Color = (232, 181, 87)
KEY: Color = (51, 190, 245)
"""Yellow, as keyframes are in Blender."""

ICON_SIZE, ICON_FRAME = 256, 19
TRUNK = ("shoulder.R", "shoulder.L", "hip.L", "hip.R")
ICON_EDGE, ICON_DOWN, NECK = 34.0, 12.0, 7.0
"""Free around the body's points; how much lower it stands, and its head higher [px]."""

SIZE = (1920, 1080)
FRAMES = (19, 47, 71, 94)
CARD = (400, 300)
CARDS_LEFT, CARDS_TOP = 64, 166
FLOOR_Y = 925.0
TURN_RAD = np.radians(-35.0)
FIGURE_SCALE = 222.0
"""Pixels a meter of the figures in space."""
TIMELINE = (976, 1080)
"""Its rows."""


def draw_icon(take: Take, motion: Motion) -> Image:
    """One frame's performer in the strong colors of the five garments, with a keyframe for a head."""
    canvas = Canvas(ICON_SIZE, ICON_SIZE, NIGHT)
    points = icon_points(motion)
    colors = {style.name: style.color_srgb[::-1] for style in take.markers}

    def limb(start: str, end: str, color: Color, width: float) -> None:
        canvas.line([points[start], points[end]], color, width)
        for name in (start, end):
            canvas.circle(points[name], 0.5 * width, color)

    for side in ("R", "L"):
        limb(f"hip.{side}", f"knee.{side}", CLOTH, 24.0)
        limb(f"knee.{side}", f"ankle.{side}", colors[f"shin.{side}"], 24.0)
        limb(f"shoulder.{side}", f"elbow.{side}", CLOTH, 21.0)
        limb(f"elbow.{side}", f"wrist.{side}", colors[f"forearm.{side}"], 21.0)
    canvas.polygon([points[name] for name in TRUNK], colors["trunk"])
    for start, end in zip(TRUNK, TRUNK[1:] + TRUNK[:1], strict=True):
        limb(start, end, colors["trunk"], 21.0)
    x, y = points["head"]
    draw_diamond(canvas, x, y - NECK, 27.0, KEY)
    return canvas.image()


def icon_points(motion: Motion) -> dict[str, Array]:
    """The body's points in the icon by name, seen from the front."""
    front = motion.points[ICON_FRAME] @ view_axes(0.0, 0.0)[:2].T * [1.0, -1.0]
    low, high = front.min(axis=0), front.max(axis=0)
    scale = (ICON_SIZE - 2.0 * ICON_EDGE) / (high - low).max()
    placed = scale * (front - 0.5 * (low + high)) + 0.5 * ICON_SIZE + [0.0, ICON_DOWN]
    return dict(zip(motion.body.skeleton.point_names, placed, strict=True))


def draw_featured(take: Take, motion: Motion, speed: Array) -> Image:
    """Four moments of the footage, the motion's figures below them, and its keyframes on a timeline."""
    canvas = Canvas(*SIZE)
    canvas.paste(draw_figures(motion), 0, 0, *SIZE)
    canvas.text("Keymark", CARDS_LEFT, 118.0, 64.0, INK)
    canvas.text(SLOGAN, canvas.width - CARDS_LEFT, 112.0, 25.0, CLOTH, "right")
    images = dict(Clip.open(take.clip, fps=take.fps).source.at(FRAMES))
    figure = stick_figure(motion)
    for frame, left in zip(FRAMES, card_lefts(), strict=True):
        canvas.box(left - 3, CARDS_TOP - 3, left + CARD[0] + 3, CARDS_TOP + CARD[1] + 3, WHITE)
        tile = Canvas(*CARD)
        tile.paste(images[frame], 0, 0, *CARD)

        def project(points: Array) -> tuple[Array, Array]:
            pixels, depth = take.camera.project(points)
            return CARD[0] / take.camera.resolution[0] * pixels, depth

        draw_figure(tile, figure, frame, project, 4.5)
        canvas.paste(tile.image(), left, CARDS_TOP, *CARD)
    draw_timeline(canvas, motion, speed)
    return canvas.image()


def draw_figures(motion: Motion) -> Image:
    """The performer at every moment as a body in space, below the footage of that moment."""
    picture = backdrop(SIZE[1], SIZE[0], FLOOR_Y, FIGURE_SCALE)
    for frame, left in zip(FRAMES, card_lefts(), strict=True):
        posture = motion.posture[frame]
        aside = FIGURE_SCALE * float(view_axes(TURN_RAD, TILT_RAD)[0] @ posture.translation)
        view = View(view_axes(TURN_RAD, TILT_RAD), FIGURE_SCALE, (left + 0.5 * CARD[0] - aside, FLOOR_Y))
        picture = draw_mannequin(picture, mannequin(motion.body, posture), view)
    return picture


def draw_timeline(canvas: Canvas, motion: Motion, speed: Array) -> None:
    """The performer's speed over the clip, with the posed keyframes on it."""
    top, bottom = TIMELINE
    canvas.box(0, top, canvas.width, bottom, NIGHT)
    across = np.linspace(CARDS_LEFT, canvas.width - CARDS_LEFT, len(speed))
    heights = bottom - 18.0 - (bottom - top - 44.0) * speed / np.nanmax(speed)
    canvas.line(np.stack([across, heights], axis=1), BLUE, 2.5)
    for index in motion.keyframe_indices:
        draw_diamond(canvas, across[index], heights[index], 12.0, KEY)


def card_lefts() -> list[int]:
    """The left edges of the pictures of the footage."""
    step = (SIZE[0] - 2 * CARDS_LEFT - CARD[0]) / (len(FRAMES) - 1)
    return [round(CARDS_LEFT + number * step) for number in range(len(FRAMES))]


def draw_diamond(canvas: Canvas, x: float, y: float, radius: float, color: Color) -> None:
    """A keyframe as animators know it."""
    canvas.polygon([[x - radius, y], [x, y - radius], [x + radius, y], [x, y + radius]], color)


def write_icon(results: Results, path: Path) -> None:
    """Reconstruct the demonstration and draw its icon."""
    take = results.take
    write_png(str(path), draw_icon(take, run(reconstruct(take, "map")).motion))


def write_featured(results: Results, path: Path) -> None:
    """Reconstruct the demonstration and draw the featured image."""
    take = results.take
    done = run(reconstruct(take, "map"))
    write_picture(path, draw_featured(take, done.motion, done.speed))
