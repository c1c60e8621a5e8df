"""A posture as a shaded mannequin in parallel projection, edges set off, its shadow on the floor."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, BoolArray, Image, SingleArray
from ..body.kinematics import Body
from ..body.posture import Posture
from .mannequin_feet import drawn_frames
from .mannequin_shape import mannequin_surface

LIGHT = np.array([-0.5, 0.75, -0.6])
"""From where the light comes, as the eye sees it: right, up, away."""
DARKEST, SHEEN = 0.45, 60.0
EDGE_COLOR = np.array([62, 54, 50])
EDGE_M = 0.04
"""A part that lies so far before what is beside it gets an edge."""
SHADOW, SOFTNESS_M, SPARSE = 0.32, 0.03, 7
"""How dark the shadow is, how soft, and that only every seventh point of the skin throws it."""
STEPS, FAR_M = 65535, 1e3
"""In how many steps depth is told apart, and what counts as the depth of nothing."""
HOLE_M = 0.01
"""A pixel that shows something so much farther than all around is a hole between points of the skin."""
FINER = 2
"""The figure is drawn this much larger and reduced at the end."""
DENSITY = 1.0
"""Points of the skin a pixel of the larger picture, along a line."""


@dataclass(frozen=True)
class View:
    """From where a figure is seen, and where it lies in the picture."""

    turn_rad: float
    """How far the eye has walked around the world's Z: at 0 it sees who faces -Y from the front, at π/2 from
    their left."""
    tilt_rad: float
    """How far it looks down."""
    scale: float
    """Pixels a meter."""
    center: tuple[float, float]
    """Where the world's origin lies in the picture: pixels to the right and down."""

    @property
    def axes(self) -> Array:
        """World directions (3, 3) to the right, upwards, and away from the eye, as rows."""
        return view_axes(self.turn_rad, self.tilt_rad)

    def project(self, places: Array) -> tuple[Array, Array]:
        """Pixels (..., 2) of world places (..., 3), and how far away these lie (...,) [m]."""
        axes = self.axes
        flat = self.scale * axes[:2] * np.array([[1.0], [-1.0]])
        pixel = places @ flat.T.astype(places.dtype) + np.array(self.center, dtype=places.dtype)
        return pixel, places @ axes[2].astype(places.dtype)


def view_axes(turn_rad: float, tilt_rad: float) -> Array:
    """World directions (3, 3) that a view shows to the right, upwards, and away from the eye, as rows."""
    right = np.array([np.cos(turn_rad), np.sin(turn_rad), 0.0])
    level = np.array([-right[1], right[0], 0.0])
    away = np.cos(tilt_rad) * level - np.sin(tilt_rad) * np.array([0.0, 0.0, 1.0])
    return np.stack([right, np.cross(right, away), away])


def _spacing_m(view: View) -> float:
    """How far points of the skin lie apart, in few steps, so that views of like scale share a skin [m]."""
    return float(2.0 ** (np.floor(-4.0 * np.log2(DENSITY * FINER * view.scale)) / 4.0))


def draw_mannequin(image: Image, body: Body, posture: Posture, view: View) -> Image:
    """A picture with a figure drawn onto it.

    Args:
        image: (height, width, 3) what is behind; left as it is.
        body: The performer.
        posture: A single posture; the floor is z = 0.
        view: From where.

    Returns:
        (height, width, 3) the picture with the figure.
    """
    height, width = image.shape[:2]
    size = (height * FINER, width * FINER)
    surface = mannequin_surface(body, _spacing_m(view))
    rotations, origins = drawn_frames(body, body.pose(posture))
    onto = view.axes * np.array([[view.scale], [-view.scale], [1.0]])
    facing, shown, thrown = [], [], []
    for frame, skin in surface.parts:
        turn, origin = rotations[frame], origins[frame]
        towards = surface.normal[skin] @ (turn.T @ view.axes[2]).astype(np.float32) < 0.0
        facing.append(np.flatnonzero(towards) + skin.start)
        shown.append(_moved(surface.place[facing[-1]], onto @ turn, onto @ origin + [*view.center, 0.0]))
        thrown.append(_moved(surface.place[skin][::SPARSE], turn, origin))
    front = np.concatenate(facing)
    nearest, depth = _nearest(np.concatenate(shown), size)
    seen = nearest >= 0
    point = front[nearest[seen]]
    shadow = _shadow(view, np.concatenate(thrown), (height, width))
    large = cv2.resize(
        image * (1.0 - SHADOW * shadow[..., None]), size[::-1], interpolation=cv2.INTER_NEAREST
    )
    light = (LIGHT / np.linalg.norm(LIGHT) @ view.axes @ rotations).astype(np.float32)  # by frame
    lit = np.sum(surface.normal[point] * light[surface.frame[point]], axis=-1)
    large[seen] = _shaded(surface.color[point], lit)
    large[_edges(depth)] = EDGE_COLOR
    reduced = cv2.resize(large, (width, height), interpolation=cv2.INTER_AREA)
    return np.asarray(np.round(np.clip(reduced, 0.0, 255.0)), dtype=np.uint8)


def _moved(place: SingleArray, turn: Array, origin: Array) -> SingleArray:
    return np.asarray(place @ turn.T.astype(np.float32) + origin.astype(np.float32))


def _pixels(at: SingleArray, size: tuple[int, int]) -> NDArray[np.int32]:
    """Which pixel each of some points (N, 2) falls into, counted row by row; one more than all: none."""
    column, row = np.floor(at[:, 0]), np.floor(at[:, 1])
    inside = (column >= 0) & (column < size[1]) & (row >= 0) & (row < size[0])
    return np.where(inside, row * size[1] + column, size[0] * size[1]).astype(np.int32)


def _shadow(view: View, place: SingleArray, size: tuple[int, int]) -> SingleArray:
    """How much of the light from above is missing, 0 to 1, on the floor z = 0."""
    mask = np.zeros(size[0] * size[1] + 1, dtype=np.float32)
    at, _ = view.project(place * np.array([1.0, 1.0, 0.0], dtype=np.float32))
    mask[_pixels(at.astype(np.float32), size)] = 1.0
    return np.asarray(cv2.GaussianBlur(mask[:-1].reshape(size), (0, 0), SOFTNESS_M * view.scale))


def _nearest(seen: SingleArray, size: tuple[int, int]) -> tuple[NDArray[np.int32], SingleArray]:
    """Which point is seen in each pixel of the larger picture, -1 where none, and how far away it is [m].

    Args:
        seen: (N, 3) pixels of the reduced picture to the right and down, and meters away.
        size: Height and width of the larger one.
    """
    pixel, away = _pixels(seen[:, :2] * np.float32(FINER), size), seen[:, 2]
    # Of several points in a pixel the last one written stays: the nearest. Whole numbers of two bytes are
    # sorted many times faster than fractions, and a figure's depth in so many steps is fine enough.
    first, last = away.min(), away.max()
    nearness = (last - away) * (np.float32(STEPS) / max(last - first, np.float32(1e-6)))
    order = np.argsort(nearness.astype(np.uint16), kind="stable")
    nearest = np.full(size[0] * size[1] + 1, -1, dtype=np.int32)
    nearest[pixel[order]] = order
    nearest = nearest[:-1].reshape(size)
    depth = np.where(nearest >= 0, away[nearest], np.float32(FAR_M))
    level = cv2.morphologyEx(depth, cv2.MORPH_OPEN, np.ones((3, 3), dtype=np.uint8))
    for row, column in zip(*np.nonzero(depth - level > HOLE_M), strict=True):
        around = slice(max(row - 1, 0), row + 2), slice(max(column - 1, 0), column + 2)
        nearest[row, column] = nearest[around].flat[np.argmin(depth[around])]
    return nearest, np.asarray(level, dtype=np.float32)


def _shaded(color: SingleArray, lit: SingleArray) -> SingleArray:
    """Colors (N, 3) where so much light (N,) falls, -1 to 1."""
    brightness = DARKEST + (1.0 - DARKEST) * (0.5 + 0.5 * lit)
    return np.asarray(1.12 * color * brightness[:, None] + SHEEN * np.clip(lit, 0.0, 1.0)[:, None] ** 12)


def _edges(depth: SingleArray) -> BoolArray:
    """Where something much nearer is beside: around the figure, and where a limb passes before another."""
    near = cv2.erode(depth, cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3)))
    return np.asarray(depth - near > EDGE_M)
