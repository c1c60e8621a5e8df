"""The pictures of a result: the estimate over the footage, and the motion from the side."""

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from ..arrays import BoolArray, Image
from ..camera.camera import Camera
from ..errors import InputError
from ..markers.reading import Reading
from ..markers.region_tracks import RegionTracks
from ..review.compared_keypoints import ComparedKeypoints
from ..take.conversion_record import PICTURES
from ..take.motion import Motion
from ..take.steady_camera import steadied_picture
from ..take.take import Take
from ..terms.contours import ContourModel
from ..video.clip import Clip
from .canvas import GRID_M, PAPER, SCALE, Canvas, View, draw_grid, side_axes, write_png
from .overlay_sheet import CELL_WIDTH, LABEL, MARGIN, evenly_spaced_frames, overlay_sheet, sheet
from .stick_figure import draw_figure, legend, stick_figure


def footage_frames(clip: Clip, frames: Sequence[int]) -> dict[int, Image]:
    """Frames of a clip by their index, rising, but unreadable ones; reduced to the width of a cell.

    Dozens of full 8K frames would fill the memory.
    """
    most, found = CELL_WIDTH * SCALE, {}
    for frame, image in clip.source.at(list(frames)):
        height, width = image.shape[:2]
        if width > most:
            size = (most, max(1, round(most * height / width)))
            image = np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)
        found[frame] = image
    return found


def glimpsed_frames(reading: Reading, there: BoolArray) -> dict[int, Image]:
    """What is kept of the clip's pictures, of the frames (F,) that count, as a steady camera shows them."""
    glimpses = reading.glimpses
    if glimpses is None:
        return {}
    kept = [frame for frame in glimpses.frames if there[frame]]
    return {frame: steadied_picture(*glimpses.picture(frame), reading, frame) for frame in kept}


def side_sheet(motion: Motion, camera: Camera, frames: Sequence[int]) -> Image:
    """Draw stick figures of some frames about their hips, in parallel projection."""
    axes, figure, names = side_axes(camera), stick_figure(motion), motion.body.skeleton.point_names
    hips, ankles = (motion.points[:, [names.index(f"{part}.{s}") for s in "LR"]] for part in ("hip", "ankle"))
    origin = hips.mean(axis=1) * [1.0, 1.0, 0.0]  # (F, 3): the ground under the hips
    lowest = float(np.nanmin(ankles[..., 2]))
    floor = 0.0 if abs(lowest) < 0.5 else lowest  # the ground plane, if the feet are near it
    seen = np.concatenate([limb.points for limb in figure.limbs], axis=1) - origin[:, None]
    seen = seen[list(frames)] @ axes[:2].T  # (K, N, 2)
    low, high = min(seen[..., 1].min(), floor), seen[..., 1].max() + figure.head_radius_m
    size, padding_m = (220, 240), 0.1
    free = size[1] - LABEL  # the frame's number must not stand over the feet
    height = high - low + 2.0 * padding_m
    scale = float(min(0.5 * size[0] / (np.abs(seen[..., 0]).max() + padding_m), free / height))
    foot = low - padding_m - 0.5 * (free / scale - height)  # height at the label's upper edge
    title = "Side view: the camera is to the left; depth runs to the right"
    footer = f"Parallel projection about the hips; grid of {GRID_M:g} m. Numbers: scene frames."

    def draw(frame: int) -> list[Image]:
        tile = Canvas(*size, PAPER)
        draw_grid(tile, scale, free - scale * (floor - foot))
        view = View(axes, scale, (0.5 * size[0], free + scale * foot), origin[frame])
        draw_figure(tile, figure, frame, view.project, 4.0, outlined=False)
        return [tile.image()]

    canvas = sheet(title, footer, frames, 6, size, draw, motion.frame_start, motion.keyframe_indices)
    legend(canvas, canvas.width - MARGIN, MARGIN + 15.0)
    return canvas.image()


def write_pictures(
    folder: Path,
    take: Take,
    motion: Motion,
    tracks: RegionTracks,
    keypoints: ComparedKeypoints | None = None,
    contours: ContourModel | None = None,
    reading: Reading | None = None,
) -> tuple[Path, ...]:
    """Write the pictures of the frames that the motion's reading has kept, else of some that are decoded."""
    folder.mkdir(parents=True, exist_ok=True)
    shown = {} if reading is None else glimpsed_frames(reading, motion.there)
    if not shown:
        known = np.flatnonzero(motion.there)
        frames = [int(known[frame]) for frame in evenly_spaced_frames(len(known))]
        shown = footage_frames(Clip.open(take.clip, take.fps, take.camera.resolution), frames)
    if not shown:
        raise InputError(f"{take.clip}: can no longer be read; the pictures need it once more")
    write_png(str(folder / PICTURES[0]), overlay_sheet(take, motion, tracks, shown, keypoints, contours))
    write_png(str(folder / PICTURES[1]), side_sheet(motion, take.camera, tuple(shown)))
    return tuple(folder / name for name in PICTURES)
