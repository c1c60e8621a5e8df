"""A posture as a shaded mannequin in parallel projection, with depth edges and a shadow on the floor."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, BoolArray, Image, SingleArray
from ..body.kinematics import Body
from ..body.posture import Posture
from .mannequin_feet import skin_frames
from .mannequin_shape import mannequin_surface

LIGHT = np.array([-0.5, 0.75, -0.6])
"""Direction to the light in view axes: right, up, away."""
DARKEST, SHEEN = 0.45, 60.0
EDGE_COLOR = np.array([62, 54, 50])
EDGE_M = 0.04
"""Depth step from which on an edge is drawn."""
SHADOW, SOFTNESS_M, SHADOW_STRIDE = 0.32, 0.03, 7
"""Darkness of the shadow, its blur, and the stride of the skin points that cast it."""
DEPTH_STEPS, FAR_M = 65535, 1e3
"""Quantization of depth for sorting, and the depth of empty pixels."""
HOLE_M = 0.01
"""A pixel farther than its neighbors by this much is a hole between points of the skin."""
SUPERSAMPLING = 2
"""The figure is drawn this much larger and reduced at the end."""
DENSITY = 1.0
"""Points of the skin per pixel of the larger picture, along a line."""


@dataclass(frozen=True)
class View:
    """Direction of view, scale and origin of a parallel projection."""

    turn_rad: float
    """Turn of the eye around the world's Z: at 0 it sees a performer who faces -Y from the front, at π/2 from
    their left."""
    tilt_rad: float
    """Downward tilt of the view."""
    scale: float
    """Pixels a meter."""
    center: tuple[float, float]
    """The world's origin in the picture: pixels to the right and down."""

    @property
    def axes(self) -> Array:
        """World directions (3, 3) to the right, upwards, and away from the eye, as rows."""
        return view_axes(self.turn_rad, self.tilt_rad)

    def project(self, points: Array) -> tuple[Array, Array]:
        """Pixels (..., 2) and depths (...,) [m] of world points (..., 3)."""
        axes = self.axes
        flat = self.scale * axes[:2] * np.array([[1.0], [-1.0]])
        pixel = points @ flat.T.astype(points.dtype) + np.array(self.center, dtype=points.dtype)
        return pixel, points @ axes[2].astype(points.dtype)


def view_axes(turn_rad: float, tilt_rad: float) -> Array:
    """World directions (3, 3) that a view shows to the right, upwards, and away from the eye, as rows."""
    right = np.array([np.cos(turn_rad), np.sin(turn_rad), 0.0])
    level = np.array([-right[1], right[0], 0.0])
    away = np.cos(tilt_rad) * level - np.sin(tilt_rad) * np.array([0.0, 0.0, 1.0])
    return np.stack([right, np.cross(right, away), away])


def _spacing_m(view: View) -> float:
    """Distance between points of the skin, in coarse steps, so that similar scales share a skin [m]."""
    return float(2.0 ** (np.floor(-4.0 * np.log2(DENSITY * SUPERSAMPLING * view.scale)) / 4.0))


def draw_mannequin(image: Image, body: Body, posture: Posture, view: View) -> Image:
    """Draw a figure onto a picture.

    Args:
        image: (height, width, 3) background; not changed.
        body: The performer.
        posture: A single posture; the floor is z = 0.
        view: The projection.

    Returns:
        (height, width, 3) picture with the figure.
    """
    height, width = image.shape[:2]
    size = (height * SUPERSAMPLING, width * SUPERSAMPLING)
    surface = mannequin_surface(body, _spacing_m(view))
    rotations, origins = skin_frames(body, posture)
    onto = view.axes * np.array([[view.scale], [-view.scale], [1.0]])
    facing, shown, thrown = [], [], []
    for frame, skin in surface.parts:
        turn, origin = rotations[frame], origins[frame]
        towards = surface.normal[skin] @ (turn.T @ view.axes[2]).astype(np.float32) < 0.0
        facing.append(np.flatnonzero(towards) + skin.start)
        shown.append(
            _transformed(surface.point[facing[-1]], onto @ turn, onto @ origin + [*view.center, 0.0])
        )
        thrown.append(_transformed(surface.point[skin][::SHADOW_STRIDE], turn, origin))
    front = np.concatenate(facing)
    nearest, depth = _depth_buffer(np.concatenate(shown), size)
    seen = nearest >= 0
    point = front[nearest[seen]]
    shadow = _shadow(view, np.concatenate(thrown), (height, width))
    large = cv2.resize(
        image * (1.0 - SHADOW * shadow[..., None]), size[::-1], interpolation=cv2.INTER_NEAREST
    )
    light = (LIGHT / np.linalg.norm(LIGHT) @ view.axes @ rotations).astype(np.float32)  # by frame
    lit = np.sum(surface.normal[point] * light[surface.frame[point]], axis=-1)
    large[seen] = _shaded(surface.color[point], lit)
    large[_depth_edges(depth)] = EDGE_COLOR
    reduced = cv2.resize(large, (width, height), interpolation=cv2.INTER_AREA)
    return np.asarray(np.round(np.clip(reduced, 0.0, 255.0)), dtype=np.uint8)


def _transformed(points: SingleArray, turn: Array, origin: Array) -> SingleArray:
    return np.asarray(points @ turn.T.astype(np.float32) + origin.astype(np.float32))


def _pixel_indices(pixels: SingleArray, size: tuple[int, int]) -> NDArray[np.int32]:
    """Flat indices of the pixels that hold points (N, 2); the number of pixels for points outside."""
    column, row = np.floor(pixels[:, 0]), np.floor(pixels[:, 1])
    inside = (column >= 0) & (column < size[1]) & (row >= 0) & (row < size[0])
    return np.where(inside, row * size[1] + column, size[0] * size[1]).astype(np.int32)


def _shadow(view: View, points: SingleArray, size: tuple[int, int]) -> SingleArray:
    """Shadow of the skin on the floor z = 0 in light from above, 0 to 1."""
    mask = np.zeros(size[0] * size[1] + 1, dtype=np.float32)
    pixels, _ = view.project(points * np.array([1.0, 1.0, 0.0], dtype=np.float32))
    mask[_pixel_indices(pixels.astype(np.float32), size)] = 1.0
    return np.asarray(cv2.GaussianBlur(mask[:-1].reshape(size), (0, 0), SOFTNESS_M * view.scale))


def _depth_buffer(seen: SingleArray, size: tuple[int, int]) -> tuple[NDArray[np.int32], SingleArray]:
    """Depth buffer of the larger picture: visible point of each pixel, -1 where none, and depth [m].

    Args:
        seen: (N, 3) pixels of the reduced picture to the right and down, and meters away.
        size: Height and width of the larger one.
    """
    pixel, away = _pixel_indices(seen[:, :2] * np.float32(SUPERSAMPLING), size), seen[:, 2]
    # Of several points in a pixel the last one written stays: the nearest. Integers of two bytes are sorted
    # many times faster than floats, and the quantization of depth is fine enough.
    first, last = away.min(), away.max()
    nearness = (last - away) * (np.float32(DEPTH_STEPS) / max(last - first, np.float32(1e-6)))
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
    """Shaded colors (N, 3) in light (N,), -1 to 1, the cosine of its incidence."""
    brightness = DARKEST + (1.0 - DARKEST) * (0.5 + 0.5 * lit)
    return np.asarray(1.12 * color * brightness[:, None] + SHEEN * np.clip(lit, 0.0, 1.0)[:, None] ** 12)


def _depth_edges(depth: SingleArray) -> BoolArray:
    """Pixels beside much nearer ones: around the figure, and where a limb passes before another."""
    near = cv2.erode(depth, cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3)))
    return np.asarray(depth - near > EDGE_M)
