"""A character as shaded triangles, drawn through any projection."""

from collections.abc import Mapping
from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array, Image, IndexArray
from ..body.body_volume import Piece, body_pieces, ring_quads
from ..body.human import STRONG
from ..body.kinematics import Body, Extremities, segment_turn
from ..body.posture import Posture, facing_rad
from ..camera.camera import Camera
from ..feet.natural_extremities import feet_on_floor
from ..feet.soles import Shins, Soles
from ..numerics.vectors import unit
from .canvas import (
    GRID_M,
    PAPER,
    Canvas,
    Color,
    Projection,
    View,
    draw_grid,
    side_axes,
    square_of,
    squares_around,
    truncated,
    view_axes,
)
from .pictures import sheet

SKIN: Color = (196, 190, 186)


@dataclass(frozen=True, eq=False)
class CharacterFigure:
    """A character in one frame."""

    points: Array  # (N, 3) corners of the triangles in the world [m]
    triangles: IndexArray  # (T, 3) rows of `points`, counterclockwise seen from outside
    colors: Array  # (T, 3) blue, green, red, 0 to 255


def draw_character(canvas: Canvas, figure: CharacterFigure, project: Projection) -> None:
    """Draw the triangles that face the eye, the farthest first."""
    if not len(figure.triangles):
        return
    pixels, depth = project(figure.points)
    corners = pixels[figure.triangles]  # (T, 3, 2)
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    # y runs down in a picture: what is counterclockwise from outside turns the other way there.
    facing = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0] < 0.0
    away = depth[figure.triangles].mean(axis=1)
    shown = np.flatnonzero(facing & np.isfinite(corners).all(axis=(1, 2)) & np.isfinite(away))
    world = figure.points[figure.triangles[shown]]
    normal = np.cross(world[:, 1] - world[:, 0], world[:, 2] - world[:, 0])
    lit = unit(normal) @ unit(np.array([0.35, -0.5, 0.8]))  # from above, before and aside
    shaded = figure.colors[shown] * (0.725 + 0.275 * lit)[:, None]
    for row in np.argsort(-away[shown], kind="stable"):
        blue, green, red = (int(value) for value in np.clip(shaded[row], 0.0, 255.0))
        canvas.polygon(corners[shown[row]], (blue, green, red))


SIDES_OF_RING, BANDS_OF_CAP, BANDS_OF_SHAFT = 16, 4, 5
TILT_RAD = 0.16  # downward tilt of the view, which shows where on the floor the feet are


def draw_mannequin(image: Image, figure: CharacterFigure, view: View) -> Image:
    """The picture (height, width, 3) with a figure, whose shadow falls on the floor z = 0."""
    height, width = image.shape[:2]
    shadow = np.zeros((height, width), dtype=np.float32)
    fallen = np.clip(view.project(figure.points * [1.0, 1.0, 0.0])[0], -1e4, 1e4).round().astype(np.int32)
    for corners in fallen[figure.triangles]:
        cv2.fillConvexPoly(shadow, corners, (1.0,))
    shadow = np.asarray(cv2.GaussianBlur(shadow, (0, 0), 0.03 * view.scale))
    canvas = Canvas(width, height)
    canvas.paste((image * (1.0 - 0.32 * shadow[..., None])).astype(np.uint8), 0, 0, width, height)
    draw_character(canvas, figure, view.project)
    return canvas.image()


def mannequin(body: Body, posture: Posture) -> CharacterFigure:
    """The body in a single posture, with feet turned where the rigid ones would go below the floor z = 0."""
    pose = body.pose(Posture.stack([posture]))
    feet = Extremities(feet_on_floor(Shins.of(body, pose), Soles.of(body)))
    points, triangles, colors = [], [], []
    quads = ring_quads(2 * BANDS_OF_CAP + BANDS_OF_SHAFT + 1, SIDES_OF_RING)
    pieces = body_pieces(body)
    head = next(piece for piece in pieces if piece.segment == "head")
    up = head.end - head.start
    length, width = 1.3 * head.half_widths[1, 1], 0.2 * head.half_widths[1, 0]
    start, widths = head.start + 0.65 * up, np.full((2, 2), width)
    tip = start - length * head.sagittal  # of a nose, by which one sees where the face is
    nose = Piece("nose", head.joint, start, tip, head.lateral, up / np.linalg.norm(up), widths)
    for piece in (*pieces, nose):
        foot = piece.segment.startswith("foot")
        turn = segment_turn(body, pose, feet, piece.segment)[0] if foot else pose.rotation[0, piece.joint]
        rings = piece.rings(SIDES_OF_RING, BANDS_OF_CAP, BANDS_OF_SHAFT).reshape(-1, 3)
        if foot:
            rings[:, 2] = np.maximum(rings[:, 2], piece.end[2])  # a flat sole
        points.append(pose.place(piece.joint, piece.start)[0] + (rings - piece.start) @ turn.T)
        corners = quads.reshape(-1, 4) + sum(map(len, points[:-1]))
        triangles += [corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]]
        side = piece.segment[-1]
        paint = STRONG[side][::-1] if side in STRONG else (186, 182, 180)
        color = np.tile(np.array(paint), (*quads.shape[:2], 1))
        if side == "R":  # a ring around each right limb marks it for color-blind eyes too
            color[BANDS_OF_CAP + BANDS_OF_SHAFT // 2] = (235, 232, 230)
        colors += [color.reshape(-1, 3)] * 2
    return CharacterFigure(np.concatenate(points), np.concatenate(triangles), np.concatenate(colors))


SIZE = 256


def posture_picture(body: Body, posture: Posture) -> Image:
    """Draw a single posture; the floor is z = 0."""
    figure, edge = mannequin(body, posture), 8
    axes = view_axes(facing_rad(-posture.rotations[0, :, 1]) + np.radians(-35.0), TILT_RAD)
    seen = View(axes, 1.0, (0.0, 0.0)).project(figure.points)[0]
    floor = View(axes, 1.0, (0.0, 0.0)).project(posture.translation * [1.0, 1.0, 0.0])[0][1]
    (left, high), (right, low) = seen.min(axis=0), seen.max(axis=0)
    low = max(low, floor + 0.1)
    scale = (SIZE - 2 * edge) / max(low - high, right - left, 1.08 * body.actor.stature_m)
    center = (0.5 * SIZE - scale * 0.5 * (left + right), SIZE - edge - scale * low)
    wall = backdrop(SIZE, SIZE, center[1] + scale * floor, scale)
    return draw_mannequin(wall, figure, View(axes, scale, center))


def backdrop(height: int, width: int, floor: float, scale: float) -> Image:
    """A floor before a wall, which begins half a meter behind the row `floor` at a scale [px/m]."""
    wall, near = np.array([250.0, 249.0, 248.0]), np.array([229.0, 225.0, 222.0])
    behind = 0.45 * scale * np.sin(TILT_RAD)
    rows = np.arange(height) + 0.5 - (floor - behind)
    share = np.clip(rows + 0.5, 0.0, 1.0)  # of each row, that is floor
    fade = np.clip(rows / (3.0 * behind), 0.0, 1.0)
    colors = wall + share[:, None] * (near + fade[:, None] * 0.6 * (wall - near) - wall)
    return np.asarray(np.repeat(np.round(colors)[:, None], width, axis=1), dtype=np.uint8)


SIDE = 220


def character_sheet(
    name: str,
    figures: Mapping[int, CharacterFigure],
    camera: Camera,
    images: Mapping[int, Image],
    frame_start: int,
    floor_m: float,
) -> Image:
    """Draw a character by frame index, in order, through the camera, from its side, and beside the footage.

    Frames of the clip, reduced or whole, are by the same index; those that are missing are left out.
    """
    title = truncated(f"{name}: through the camera, and from the side")
    words = (
        f"From the side in parallel projection about the hips; grid of {GRID_M:g} m. Numbers: scene frames."
    )
    points = {frame: figure.points for frame, figure in figures.items()}
    centers, side_px = squares_around(points, camera, list(figures))
    corners = dict(zip(figures, centers - 0.5 * side_px, strict=True))
    # Side of the view from the side, in heights or widths of the largest figure.
    room = 1.15
    side_m = room * max(np.ptp(figure.points, axis=0).max() for figure in figures.values())

    def draw(frame: int) -> list[Image]:
        figure, image, corner = figures[frame], images.get(frame), corners[frame]
        footage, through, side = (Canvas(SIDE, SIDE, PAPER) for _ in range(3))

        def project(places: Array) -> tuple[Array, Array]:
            pixels, depth = camera.project(places, frame)
            return (pixels - corner) * (SIDE / side_px), depth

        draw_character(through, figure, project)
        # From its left side as the camera sees it, over a grid that begins at the floor.
        middle = 0.5 * (figure.points.min(axis=0) + figure.points.max(axis=0)) * [1.0, 1.0, 0.0]
        scale = SIDE / side_m
        low_m = min(float(figure.points[:, 2].min()), floor_m) - 0.5 * (1.0 - 1.0 / room) * side_m
        draw_grid(side, scale, SIDE - scale * (floor_m - low_m))
        view = View(side_axes(camera), scale, (0.5 * SIDE, SIDE + scale * low_m), middle)
        draw_character(side, figure, view.project)
        tiles = [through.image(), side.image()]
        if not images:
            return tiles
        seen = footage.image() if image is None else square_of(image, corner, side_px, camera.resolution)
        return [seen, *tiles]

    return sheet(title, words, figures, len(figures), (SIDE, SIDE), draw, frame_start).image()
