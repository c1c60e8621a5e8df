"""A posture as a shaded mannequin in parallel projection, edges set off, its shadow on the floor."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..body.kinematics import Body
from ..body.posture import Posture
from .canvas import Image
from .mannequin_feet import drawn_frames
from .mannequin_shape import mannequin_surface

Array = NDArray[np.float64]

LIGHT = np.array([-0.5, 0.75, -0.6])
"""From where the light comes, as the eye sees it: right, up, away."""
DARKEST, SHEEN = 0.45, 60.0
EDGE_COLOR = np.array([62, 54, 50])
EDGE_M = 0.04
"""A part that lies so far before what is beside it gets an edge."""
SHADOW, SOFTNESS_M, SPARSE = 0.32, 0.03, 7
"""How dark the shadow is, how soft, and that only every seventh point of the skin throws it."""
FINER = 2
"""The figure is drawn this much larger and reduced at the end."""
DENSITY = 1.3
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
    """Pixels a metre."""
    centre: tuple[float, float]
    """Where the world's origin lies in the picture: pixels to the right and down."""

    @property
    def axes(self) -> Array:
        """World directions (3, 3) to the right, upwards, and away from the eye, as rows."""
        return view_axes(self.turn_rad, self.tilt_rad)

    def project(self, places: Array) -> tuple[Array, Array]:
        """Pixels (..., 2) of world places (..., 3), and how far away these lie (...,) [m]."""
        seen = places @ self.axes.T
        pixel = np.array(self.centre) + self.scale * seen[..., :2] * np.array([1.0, -1.0])
        return pixel, seen[..., 2]


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
    place, towards = [], []
    for frame, skin in surface.parts:
        place.append(origins[frame] + surface.place[skin] @ rotations[frame].T)
        towards.append(surface.normal[skin] @ (rotations[frame].T @ view.axes[2]) < 0.0)
    places, facing = np.concatenate(place), np.flatnonzero(np.concatenate(towards))
    nearest, depth = _nearest(view, places[facing], size)
    seen = nearest >= 0
    point = facing[nearest[seen]]
    large = cv2.resize(image, size[::-1], interpolation=cv2.INTER_NEAREST).astype(np.float32)
    large *= 1.0 - SHADOW * _shadow(view, places, size)[..., None]
    turn = rotations[surface.frame[point]]
    large[seen] = _shaded(surface.color[point], np.einsum("nij,nj->ni", turn, surface.normal[point]), view)
    large[_edges(depth)] = EDGE_COLOR
    reduced = cv2.resize(np.clip(large, 0.0, 255.0), (width, height), interpolation=cv2.INTER_AREA)
    return np.asarray(np.round(reduced), dtype=np.uint8)


def _pixels(view: View, place: Array, size: tuple[int, int]) -> tuple[NDArray[np.intp], Array]:
    """The pixel that each place falls into, counted row by row, -1 outside; and how far away it is."""
    at, away = view.project(place)
    column, row = np.floor(at * FINER).astype(np.intp).T
    inside = (column >= 0) & (column < size[1]) & (row >= 0) & (row < size[0])
    return np.where(inside, row * size[1] + column, -1), away


def _shadow(view: View, place: Array, size: tuple[int, int]) -> NDArray[np.float32]:
    """How much of the light from above is missing, 0 to 1, on the floor z = 0."""
    mask = np.zeros(size[0] * size[1] + 1, dtype=np.float32)
    mask[_pixels(view, place[::SPARSE] * [1.0, 1.0, 0.0], size)[0]] = 1.0
    dense = cv2.dilate(mask[:-1].reshape(size), np.ones((3, 3)))
    return np.asarray(cv2.GaussianBlur(dense, (0, 0), SOFTNESS_M * view.scale * FINER), dtype=np.float32)


def _nearest(view: View, place: Array, size: tuple[int, int]) -> tuple[NDArray[np.intp], Array]:
    """Which point is seen in each pixel, -1 where none, and how far away it is [m]."""
    pixel, away = _pixels(view, place, size)
    order = np.argsort(-away)  # of several points in a pixel the last one written stays: the nearest
    nearest = np.full(size[0] * size[1] + 1, -1, dtype=np.intp)
    nearest[pixel[order]] = order
    nearest = nearest[:-1].reshape(size)
    return nearest, np.where(nearest >= 0, away[nearest], np.inf)


def _shaded(color: Array, normal: Array, view: View) -> Array:
    light = LIGHT / np.linalg.norm(LIGHT) @ view.axes
    lit = normal @ light
    brightness = DARKEST + (1.0 - DARKEST) * (0.5 + 0.5 * lit)
    return np.asarray(1.12 * color * brightness[:, None] + SHEEN * (np.clip(lit, 0.0, 1.0) ** 12)[:, None])


def _edges(depth: Array) -> NDArray[np.bool_]:
    """Where something much nearer is beside: around the figure, and where a limb passes before another."""
    far = np.where(np.isinf(depth), 1e3, depth).astype(np.float32)
    near = cv2.erode(far, cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3)))
    return np.asarray(far - near > EDGE_M)
