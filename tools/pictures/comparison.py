"""The demonstration's motion by each method over both cameras.

The upper rows show the footage used, the lower ones the reference camera from the side, which no method saw.
"""

import json

import numpy as np
from keymark.core.api import reconstruct
from keymark.core.arrays import Image
from keymark.core.camera.camera import Camera
from keymark.core.progress import run
from keymark.core.report.canvas import INK, Canvas, draw_figure, stick_figure
from keymark.core.take.conversion_settings import METHODS
from keymark.core.take.motion import Motion
from keymark.core.take.take_file import read_take
from keymark.core.video.clip import Clip

from .results import DEMO, KEYFRAMES

FRAMES = (19, 36, 60, 75, 88, 100)
CELL = (200, 150)
GAP, TITLE = 6, 26
NAMES = {"interpolation": "keyframes interpolated", "ekf": "the paper's filter", "map": "whole clip"}


def draw_rows(canvas: Canvas, top: int, clip: Clip, camera: Camera, motion: Motion, title: str) -> None:
    """One row: frames of a clip with a motion over them."""
    canvas.text(title, GAP, top + 18, 10.0, INK)
    images = dict(clip.source.at(FRAMES))
    figure = stick_figure(motion)
    scale = CELL[0] / camera.resolution[0]
    for column, frame in enumerate(FRAMES):
        tile = Canvas(*CELL)
        tile.paste(np.asarray(0.6 * images[frame] + 100.0, dtype=np.uint8), 0, 0, *CELL)

        def project(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            pixels, depth = camera.project(points)
            return scale * pixels, depth

        draw_figure(tile, figure, frame, project, 2.5)
        canvas.paste(tile.image(), GAP + column * (CELL[0] + GAP), top + TITLE, *CELL)


def draw_comparison() -> Image:
    """Reconstruct with every method and draw."""
    take = read_take(DEMO, KEYFRAMES)
    side = json.loads((DEMO / "side.json").read_text(encoding="utf-8"))
    views = (
        ("front", Clip.open(take.clip, fps=take.fps), take.camera),
        ("side, not used", Clip.open(DEMO / side["clip"], fps=take.fps), Camera.from_dict(side["camera"])),
    )
    methods = METHODS[::-1]
    row = TITLE + CELL[1] + GAP
    canvas = Canvas(GAP + len(FRAMES) * (CELL[0] + GAP), len(views) * len(methods) * row)
    reading = None  # shared by all methods
    for i, method in enumerate(methods):
        done = run(reconstruct(take, method, reading))
        motion, reading = done.motion, done.reading
        for j, (view, clip, camera) in enumerate(views):
            title = f"{NAMES[method]} ({view})"
            draw_rows(canvas, (j * len(methods) + i) * row, clip, camera, motion, title)
    return canvas.image()
