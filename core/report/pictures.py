"""The pictures of a result: the estimate over the footage, and the motion from the side."""

from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path

import cv2
import numpy as np

from ..arrays import Array, Image
from ..camera.camera import Camera
from ..errors import InputError
from ..estimate.reconstruct import Reconstruction
from ..markers.reading import Reading
from ..markers.region_tracks import RegionTracks
from ..markers.regions import ellipse_outline
from ..review.compared_keypoints import ComparedKeypoints
from ..take.conversion_record import PICTURES
from ..take.motion import Motion
from ..take.steady_camera import steadied_picture
from ..take.take import Take
from ..terms.contours import SHARES, SIDES, ContourModel
from ..video.clip import Clip
from .canvas import (
    ACCENT,
    GRAY,
    GRID_M,
    INK,
    PAPER,
    SCALE,
    WHITE,
    Canvas,
    Color,
    View,
    draw_figure,
    draw_grid,
    legend,
    side_axes,
    stick_figure,
    truncated,
    write_png,
)

OUTLINE: Color = (150, 70, 150)


def performer_contours(reconstruction: Reconstruction) -> ContourModel:
    """The contours of a reconstruction's performer: those learned from the footage, or of an average body."""
    solution = reconstruction.solution
    if solution is not None and solution.contours is not None:
        return solution.contours.model
    return ContourModel.average(reconstruction.motion.body, reconstruction.model.camera)


SOURCE_COLORS: tuple[Color, ...] = ((167, 121, 204), (66, 228, 240), (233, 180, 86), (0, 159, 230))
"""Purple, yellow, sky blue and orange for the first sources, Okabe and Ito's beside those of the limbs."""
THROWN_OUT: Color = (40, 30, 200)


def draw_keypoints(
    canvas: Canvas, keypoints: ComparedKeypoints, frame: int, to_canvas: Callable[[Array], Array]
) -> None:
    """Draw a frame's keypoints: crosses, slanting if thrown out, in a square if sides are exchanged."""
    seen, predicted = to_canvas(keypoints.seen[frame]), to_canvas(keypoints.predicted[frame])
    sources = list(dict.fromkeys(keypoints.sources))
    colors = [SOURCE_COLORS[sources.index(source) % len(SOURCE_COLORS)] for source in keypoints.sources]
    thrown_out, swapped = keypoints.thrown_out[frame], keypoints.swapped[frame]
    rows = predicted[np.isfinite(predicted).all(axis=-1), 1]
    size = float(np.clip(np.ptp(rows) / 220.0, 0.5, 1.0)) if len(rows) else 1.0
    for index, color in enumerate(colors):
        if not thrown_out[index]:
            canvas.line([seen[index], predicted[index]], color, 1.0)
    for place, color in zip(predicted, colors, strict=True):
        canvas.circle(place, size * 2.2, WHITE, 2.0)
        canvas.circle(place, size * 2.2, color, 1.0)
    for index in np.flatnonzero(np.isfinite(seen).all(axis=-1)):
        place, reach = seen[index], 3.4 * size
        arms = reach * (np.array([[0.7, 0.7], [0.7, -0.7]]) if thrown_out[index] else np.eye(2))
        for width, ink in ((2.0, WHITE), (1.0, THROWN_OUT if thrown_out[index] else colors[index])):
            for arm in arms:
                canvas.line([place - arm, place + arm], ink, width)
            if swapped[index]:
                corners = place + 1.2 * reach * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
                canvas.line(corners, ink, width, closed=True)


def draw_keypoint_legend(
    canvas: Canvas, keypoints: ComparedKeypoints, left: float, right: float, y: float
) -> None:
    """Explain the marks on a line with its baseline at `y` that ends at `right`; nothing if it lacks room."""
    names = [truncated(source, 150.0, 8.0) for source in dict.fromkeys(keypoints.sources)]
    words = [("Cross: keypoint of", GRAY)]
    words += [(name, SOURCE_COLORS[index % len(SOURCE_COLORS)]) for index, name in enumerate(names)]
    words.append(("slanting: not believed; boxed: sides exchanged; ring: where the motion puts it", GRAY))
    x = right - sum(canvas.text_width(word, 8.0) + 8.0 for word, _ in words)
    if x < left:
        return
    for word, color in words:
        canvas.text(word, x, y, 8.0, color)
        x += canvas.text_width(word, 8.0) + 8.0


MARGIN, GAP, TITLE, LABEL = 16, 8, 34, 20  # of a sheet, and the height of its frames' numbers [px]


def evenly_spaced_frames(frame_count: int, most: int = 12) -> tuple[int, ...]:
    """At most `most` frame indices of the clip, evenly spaced, with the first and the last."""
    return tuple(int(i) for i in np.unique(np.round(np.linspace(0, frame_count - 1, min(most, frame_count)))))


def sheet(
    title: str,
    footer: str,
    frames: Collection[int],
    columns: int,
    size: tuple[int, int],
    draw: Callable[[int], Sequence[Image]],
    frame_start: int,
    keyframes: Collection[int] = (),
) -> Canvas:
    """A title above, a line of explanation below, and the pictures of each frame, row by row.

    `draw` gives the pictures of a frame, which have a `size` and lie below each other; the lowest has its
    scene frame in the corner, with a diamond at keyframes.
    """
    pictures = {frame: draw(frame) for frame in frames}
    columns = min(columns, len(frames))
    rows = -(-len(frames) // columns)
    across, below = size[0] + GAP, size[1] + GAP
    cell = below * len(next(iter(pictures.values())))
    height = MARGIN + TITLE + rows * cell - GAP + 22 + MARGIN
    canvas = Canvas(2 * MARGIN + columns * across - GAP, height)
    canvas.text(title, MARGIN, MARGIN + 15, 12.0, INK)
    canvas.text(footer, MARGIN, height - MARGIN, 8.0, GRAY)
    for index, (frame, own) in enumerate(pictures.items()):
        left, top = MARGIN + index % columns * across, MARGIN + TITLE + index // columns * cell
        for row, picture in enumerate(own):
            canvas.paste(picture, left, top + row * below, *size)
        words = f"{frame + frame_start} key" if frame in keyframes else f"{frame + frame_start}"
        width = canvas.text_width(words) + (28.0 if frame in keyframes else 14.0)
        right, bottom = left + size[0], top + cell - GAP
        canvas.box(right - width, bottom - LABEL, right, bottom, ACCENT if frame in keyframes else INK)
        canvas.text(words, right - 7.0, bottom - 5.5, 9.0, WHITE, "right")
        if frame in keyframes:
            x, y = right - width + 11.0, bottom - 10.0
            canvas.polygon([[x - 4.5, y], [x, y - 4.5], [x + 4.5, y], [x, y + 4.5]], WHITE)
    return canvas


CELL_WIDTH = 400


def overlay_sheet(
    take: Take,
    motion: Motion,
    tracks: RegionTracks,
    images: Mapping[int, Image],
    keypoints: ComparedKeypoints | None = None,
    contours: ContourModel | None = None,
) -> Image:
    """Draw frames of the clip with the skeleton and what was seen of the performer over them."""
    width, height = take.camera.resolution
    size = CELL_WIDTH, round(CELL_WIDTH * height / width)
    title = f"Estimate over the footage ({motion.method}, {len(motion.time_s)} frames)"
    outlines = None if tracks.names else contours
    footer = "Numbers: scene frames; key: keyframes."
    if tracks.names:
        footer = f"Ellipse and cross: region found of each marker. {footer}"
    elif outlines is not None:
        footer = f"Lines beside the limbs: contours as the motion predicts them. {footer}"
    figure = stick_figure(motion)
    pose = motion.body.pose(motion.posture)
    scale = CELL_WIDTH / width

    def draw(frame: int) -> list[Image]:
        tile = Canvas(*size)  # of its own, which clips what leaves the picture
        tile.paste(paler(images[frame]), 0, 0, *size)
        if outlines is not None:
            # Contour lines that the motion predicts, those of nearer parts over others.
            index = slice(frame, frame + 1)
            predicted = outlines.evaluate(pose[index], np.array([frame]))
            pixels = (scale * predicted.pixel[0]).reshape(-1, len(SHARES), len(SIDES), 2)
            depth = predicted.depth[0].reshape(len(pixels), -1).mean(axis=1)
            for part in np.argsort(-depth):
                for side in range(len(SIDES)):
                    line = pixels[part, :, side]
                    tile.line(line, WHITE, 2.4)
                    tile.line(line, OUTLINE, 1.2)

        def project(points: Array) -> tuple[Array, Array]:
            pixels, depth = take.camera.project(points, frame)
            return scale * pixels, depth

        draw_figure(tile, figure, frame, project, 3.5)
        for style, center, moment in zip(
            take.markers, tracks.centroid[frame], tracks.second_moment[frame], strict=False
        ):
            red, green, blue = style.color_srgb
            outline = ellipse_outline(scale * center, scale**2 * moment)
            tile.line(outline, WHITE, 2.6, closed=True)
            tile.line(outline, (blue, green, red), 1.4, closed=True)
            for step in 4.0 * np.eye(2):
                tile.line([scale * center - step, scale * center + step], WHITE, 2.4)
                tile.line([scale * center - step, scale * center + step], INK, 1.0)
        if keypoints is not None:
            draw_keypoints(tile, keypoints, frame, lambda pixels: scale * pixels)
        return [tile.image()]

    canvas = sheet(title, footer, images, 4, size, draw, motion.frame_start, motion.keyframe_indices)
    legend(canvas, canvas.width - MARGIN, MARGIN + 15.0)
    if keypoints is not None and keypoints.names:
        left = MARGIN + canvas.text_width(footer, 8.0) + 2.0 * MARGIN
        draw_keypoint_legend(canvas, keypoints, left, canvas.width - MARGIN, canvas.height - MARGIN)
    return canvas.image()


def paler(image: Image) -> Image:
    """The footage a little paler and grayer, so that drawings over it stand out."""
    gray = cv2.cvtColor(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), cv2.COLOR_GRAY2BGR)
    mixed = 0.7 * image.astype(np.float64) + 0.12 * gray + 0.18 * 255.0
    return np.asarray(np.clip(mixed, 0.0, 255.0), dtype=np.uint8)


def footage_frames(clip: Clip, frames: Sequence[int]) -> dict[int, Image]:
    """Frames of a clip by index, but unreadable ones, no larger than drawn: dozens of 8K fill the memory."""
    most, found = CELL_WIDTH * SCALE, {}
    for frame, image in clip.source.at(list(frames)):
        height, width = image.shape[:2]
        if width > most:
            size = (most, max(1, round(most * height / width)))
            image = np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)
        found[frame] = image
    return found


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
        draw_figure(tile, figure, frame, view.project, 4.0)
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
    shown: dict[int, Image] = {}
    if reading is not None and (glimpses := reading.glimpses) is not None:
        kept = [frame for frame in glimpses.frames if motion.there[frame]]
        shown = {frame: steadied_picture(*glimpses.picture(frame), reading, frame) for frame in kept}
    if not shown:
        known = np.flatnonzero(motion.there)
        frames = [int(known[frame]) for frame in evenly_spaced_frames(len(known))]
        shown = footage_frames(Clip.open(take.clip, take.fps, take.camera.resolution), frames)
    if not shown:
        raise InputError(f"{take.clip}: can no longer be read; the pictures need it once more")
    write_png(str(folder / PICTURES[0]), overlay_sheet(take, motion, tracks, shown, keypoints, contours))
    write_png(str(folder / PICTURES[1]), side_sheet(motion, take.camera, tuple(shown)))
    return tuple(folder / name for name in PICTURES)
