"""The moving picture: the demonstration's footage, what is seen in it, its motion, and a character's."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from keymark.core.api import reconstruct
from keymark.core.arrays import Array, Image
from keymark.core.camera.camera import Camera
from keymark.core.markers.color_model import ColorModel
from keymark.core.markers.marker_check import check_markers
from keymark.core.markers.regions import color_masks, mask_outlines
from keymark.core.progress import run
from keymark.core.report.canvas import WHITE, Canvas, Color, StickFigure, draw_figure, stick_figure
from keymark.core.report.pictures import paler
from keymark.core.review.review import Review, review
from keymark.core.take.take import Take
from keymark.core.video.clip import Clip, sample_clip
from studio.viewpoint import look_from

from .results import BLEND, CHARACTER, Results
from .stage import render_result

STEP = 2
"""Of the footage's frames every second one is shown."""
HOLD_MS = 500
"""How long the last frame stays, before all begins again."""
QUALITIES = range(92, 40, -4)
MOST_BYTES = 2_500_000
WIDTH, GAP, TITLE, STRIP = 960, 8, 32, 64
PANEL = (234, 280)
MIDDLE = (0.25, 0.0, 1.02)
"""Of the space in which the performer moves [m]."""
HEIGHT_M = 2.36
"""What a panel shows of it, in height; a character is larger."""
CHARACTER_HEIGHT_M, CHARACTER_Z_M = 2.72, 1.16
DISTANCE_M, EYE_M = 6.0, 1.5
SWING_DEG, FRONT_DEG = 48.0, -10.0
"""By how much the view of the motion swings to either side, and where the character is seen from."""
SAMPLES = 10
BACKGROUND: Color = (30, 26, 24)
FAINT: Color = (150, 144, 138)
SURE: Color = (150, 190, 40)
GOLD: Color = (60, 190, 250)
TITLES = ("Your video", "What Keymark follows", "The motion in 3D", "Your character")
ROUND_PX = 7


@dataclass(frozen=True, eq=False)
class _Seen:
    """The demonstration as Keymark sees it."""

    take: Take
    judged: Review
    model: ColorModel
    figure: StickFigure
    images: dict[int, Image]


def draw_moving_picture(results: Results, output: Path) -> None:
    """Draw all frames and write them as an animated WebP.

    Raises:
        SystemExit: No quality makes it small enough.
    """
    seen = _see(results.take)
    frames = list(range(0, len(seen.judged.frames), STEP))
    turned = render_result(
        results.converted / BLEND, frames, lambda frame: _orbit(frame / len(seen.judged.frames)), SAMPLES
    )
    character = render_result(results.character / CHARACTER, frames, lambda _: _before_character(), SAMPLES)
    pictures = [_picture(seen, frame, (turned[row], character[row])) for row, frame in enumerate(frames)]
    write_animation(output, pictures, round(1000.0 * STEP / seen.take.fps))


def write_animation(output: Path, pictures: list[Image], milliseconds: int) -> None:
    """Write an endless loop at the best quality that is small enough.

    Raises:
        SystemExit: There is none.
    """
    animation = cv2.Animation()
    animation.frames = pictures
    animation.durations = np.array([milliseconds] * (len(pictures) - 1) + [HOLD_MS])
    animation.loop_count = 0
    draft = output.with_name(f"draft_{output.name}")
    try:
        for quality in QUALITIES:
            cv2.imwriteanimation(str(draft), animation, [cv2.IMWRITE_WEBP_QUALITY, quality])
            if draft.stat().st_size <= MOST_BYTES:
                draft.replace(output)
                return
    finally:
        draft.unlink(missing_ok=True)
    raise SystemExit(f"{output}: no quality makes it {MOST_BYTES} bytes small; show fewer frames")


def _see(take: Take) -> _Seen:
    clip = Clip.open(take.clip, fps=take.fps)
    done = run(reconstruct(take, "map"))
    count = len(done.motion.time_s)
    judged = run(review(take, done, take.frame_start + np.arange(float(count))))
    check = run(check_markers(run(sample_clip(clip)), take.markers))
    return _Seen(take, judged, check.model, stick_figure(done.motion), dict(clip.source.at(range(count))))


def _orbit(share: float) -> Camera:
    """A view of the performer that swings to both sides once in the clip."""
    azimuth = SWING_DEG * float(np.sin(2.0 * np.pi * share))
    return look_from(azimuth, DISTANCE_M, EYE_M, MIDDLE, _lens(HEIGHT_M), PANEL)


def _before_character() -> Camera:
    """The view of the character, about the performer's own."""
    target = (*MIDDLE[:2], CHARACTER_Z_M)
    return look_from(FRONT_DEG, DISTANCE_M, EYE_M, target, _lens(CHARACTER_HEIGHT_M), PANEL)


def _lens(height_m: float) -> float:
    """Focal length [mm] with which so much fills a panel at the usual distance."""
    return 36.0 * DISTANCE_M / (height_m * PANEL[0] / PANEL[1])


def _window(camera: Camera) -> tuple[float, float, float]:
    """Left and top edge of what is shown of the footage [px], and how much larger it is shown."""
    low, high = (np.array([*MIDDLE[:2], MIDDLE[2] + side * 0.5 * HEIGHT_M]) for side in (-1.0, 1.0))
    bottom, top = camera.project(np.stack([low, high]))[0]
    tall = min(bottom[1] - top[1], float(camera.resolution[1]))
    scale = PANEL[1] / tall
    upper = float(np.clip(top[1], 0.0, camera.resolution[1] - tall))
    return float(0.5 * (bottom[0] + top[0]) - 0.5 * PANEL[0] / scale), upper, scale


def _picture(seen: _Seen, frame: int, rendered: tuple[Image, Image]) -> Image:
    """One frame of the moving picture."""
    canvas = Canvas(WIDTH, TITLE + PANEL[1] + STRIP, BACKGROUND)
    plain = _footage(seen, frame)
    panels = (plain, _overlay(seen, frame, plain), *rendered)
    for column, (title, panel) in enumerate(zip(TITLES, panels, strict=True)):
        left = column * (PANEL[0] + GAP)
        canvas.paste(_rounded(panel), left, TITLE, *PANEL)
        canvas.text(title, left + 3.0, TITLE - 10.0, 10.5, WHITE)
    _strip(canvas, seen.judged, frame)
    return canvas.image()


def _footage(seen: _Seen, frame: int) -> Image:
    left, top, scale = _window(seen.take.camera)
    move = np.array([[scale, 0.0, -scale * left], [0.0, scale, -scale * top]])
    # Pixel centers lie half a pixel from the corners from which coordinates count.
    move[:, 2] += 0.5 * (scale - 1.0)
    shown = cv2.warpAffine(
        seen.images[frame], move, PANEL, flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE
    )
    return np.asarray(shown, dtype=np.uint8)


def _overlay(seen: _Seen, frame: int, plain: Image) -> Image:
    """The markers' masks and the skeleton over the footage."""
    tile = Canvas(*PANEL)
    tile.paste(paler(plain), 0, 0, *PANEL)
    left, top, scale = _window(seen.take.camera)

    def shown(pixels: Array) -> Array:
        return np.asarray(scale * (pixels - np.array([left, top])))

    for mask, style in zip(color_masks(seen.images[frame], seen.model), seen.take.markers, strict=True):
        red, green, blue = style.color_srgb
        grid = seen.take.camera.resolution[0] / mask.shape[1]
        for outline in mask_outlines(mask, grid):
            if len(outline) > 12:
                tile.line(shown(outline), WHITE, 3.2, closed=True)
                tile.line(shown(outline), (blue, green, red), 1.8, closed=True)

    def project(points: Array) -> tuple[Array, Array]:
        pixels, depth = seen.take.camera.project(points, frame)
        return shown(pixels), depth

    draw_figure(tile, seen.figure, frame, project, 3.2)
    near = np.abs(seen.judged.keyframe_indices - frame).min()
    if near <= STEP // 2:
        _badge(tile)
    return tile.image()


def _badge(tile: Canvas) -> None:
    """Says that this pose is a person's."""
    words = "posed by hand"
    width = tile.text_width(words, 9.0) + 34.0
    tile.box(PANEL[0] - width - 8.0, 8.0, PANEL[0] - 8.0, 31.0, BACKGROUND)
    _diamond(tile, PANEL[0] - width + 5.0, 19.5, 6.0, GOLD)
    tile.text(words, PANEL[0] - 18.0, 24.0, 9.0, WHITE, "right")


def _diamond(canvas: Canvas, x: float, y: float, size: float, color: Color) -> None:
    canvas.polygon([[x, y - size], [x + size, y], [x, y + size], [x - size, y]], color)


def _strip(canvas: Canvas, judged: Review, frame: int) -> None:
    """Keyframes and confidence under the panels, and where the clip is."""
    count = len(judged.confidence)
    top, low = TITLE + PANEL[1] + 10.0, canvas.height - 26.0
    left, right = 8.0, WIDTH - 8.0
    x = left + (right - left) * np.arange(count) / (count - 1)
    y = low - (low - top) * np.nan_to_num(judged.confidence)
    for first in range(count - 1):
        color = SURE if first < frame else tuple(round(0.42 * value + 14) for value in SURE)
        canvas.polygon(
            [[x[first], low], [x[first], y[first]], [x[first + 1], y[first + 1]], [x[first + 1], low]], color
        )
    for index in judged.keyframe_indices:
        _diamond(canvas, float(x[index]), low, 5.5, BACKGROUND)
        _diamond(canvas, float(x[index]), low, 4.5, GOLD if index <= frame else FAINT)
    canvas.line([[x[frame], top - 4.0], [x[frame], low + 7.0]], WHITE, 1.6)
    words = f"{len(judged.keyframe_indices)} poses by hand"
    canvas.text(words, left, canvas.height - 5.0, 8.0, GOLD)
    canvas.text(
        f"{count} frames of motion, and how sure each is", right, canvas.height - 5.0, 8.0, SURE, "right"
    )


def _rounded(panel: Image) -> Image:
    """A panel with round corners."""
    large = Canvas(PANEL[0], PANEL[1], (0, 0, 0))
    width, height, r = float(PANEL[0]), float(PANEL[1]), float(ROUND_PX)
    large.box(r, 0.0, width - r, height, WHITE)
    large.box(0.0, r, width, height - r, WHITE)
    for x in (r, width - r):
        for y in (r, height - r):
            large.circle([x, y], r, WHITE)
    share = large.image() / 255.0
    return np.asarray(np.rint(share * panel + (1.0 - share) * np.array(BACKGROUND)), dtype=np.uint8)
