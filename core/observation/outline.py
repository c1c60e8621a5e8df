"""Where the visible outline of a tapered elliptical cylinder lies, as weighted sample points.

Samples fill the silhouette between the two contour lines, and the elliptical ends. Each is a point of
the solid: a contour line touches the surface where the cross-section reaches farthest across the view,
so moving the samples rigidly with the segment moves the silhouette rightly to first order.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..body.kinematics import Pose
from ..body.shapes import Piece
from ..footage.camera import Camera

Array = NDArray[np.float64]

ALONG, ACROSS = 8, 4
RINGS, SPOKES = 2, 5
SAMPLES = ALONG * ACROSS + 2 * RINGS * SPOKES
TINY = 1e-9


@dataclass(frozen=True, eq=False)
class Outline:
    """Sample points of one piece's silhouette in F frames."""

    joint: int
    world: Array
    """(F, S, 3) [m]."""
    area: Array
    """(F, S) share of the silhouette [m², across the view]."""
    area_rate: Array
    """(F, S, 3) d area / d angular velocity in world axes [m² per rad]: foreshortening."""


def viewing_directions(camera: Camera, points: Array, frame: NDArray[np.intp]) -> Array:
    """Unit vectors (F, 3) from the camera to world points (F, 3)."""
    matrix = camera.matrix_world[frame] if camera.is_moving else camera.matrix_world
    offset = points - matrix[..., :3, 3]
    return np.asarray(offset / np.linalg.norm(offset, axis=-1, keepdims=True))


def _normalise(vector: Array, fallback: Array) -> tuple[Array, Array]:
    length = np.linalg.norm(vector, axis=-1, keepdims=True)
    unit = np.where(length > 1e-6, vector / np.maximum(length, TINY), fallback)
    return unit, length[..., 0]


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.sum(a * b, axis=-1))


@dataclass(frozen=True, eq=False)
class View:
    """A piece's axes as the camera sees them, all in the world, (F, 3) or (F,)."""

    start: Array
    end: Array
    toward: Array
    """Viewing direction, away from the camera."""
    across: Array
    """Unit direction across both the view and the axis."""
    along: Array
    """Unit direction of the axis, across the view."""
    apparent_length: Array
    """(F,) length of the axis across the view [m]."""
    lateral: Array
    sagittal: Array

    def support(self, direction: Array, widths: Array) -> Array:
        """(F,) how far a cross-section of half-widths (2,) [m] reaches in a direction (F, 3)."""
        return np.hypot(
            widths[0] * _dot(direction, self.lateral), widths[1] * _dot(direction, self.sagittal)
        )


def view_piece(piece: Piece, pose: Pose, camera: Camera, frame: NDArray[np.intp]) -> View:
    """How the camera sees a piece in each frame."""
    start, end = piece.ends(pose)
    view = viewing_directions(camera, 0.5 * (start + end), frame)
    axis = end - start
    turn = pose.rotation[..., piece.joint, :, :]
    lateral, sagittal = turn @ piece.lateral, turn @ piece.sagittal
    seen = axis - _dot(axis, view)[..., None] * view
    # Seen end on, any direction across the view will do.
    spare = lateral - _dot(lateral, view)[..., None] * view
    spare = spare / np.maximum(np.linalg.norm(spare, axis=-1, keepdims=True), TINY)
    along, length = _normalise(seen, spare)
    return View(start, end, view, np.cross(view, along), along, length, lateral, sagittal)


def outline(piece: Piece, view: View) -> Outline:
    """Samples of a piece's silhouette."""
    parts = [_wall(piece, view)]
    for centre, widths, sign in (
        (view.start, piece.half_widths[0], -1.0),
        (view.end, piece.half_widths[1], 1.0),
    ):
        parts.append(_cap(centre, widths, sign, view))
    world, area, rate = zip(*parts, strict=True)
    return Outline(piece.joint, *(np.concatenate(rows, axis=1) for rows in (world, area, rate)))


def _wall(piece: Piece, view: View) -> tuple[Array, Array, Array]:
    """Samples between the contour lines (F, ALONG * ACROSS, 3), their areas and area rates."""
    u = (np.arange(ALONG) + 0.5) / ALONG
    v = (np.arange(ACROSS) + 0.5) / ACROSS * 2.0 - 1.0
    widths = piece.half_widths[0] + u[:, None] * (piece.half_widths[1] - piece.half_widths[0])  # (U, 2)
    reach = np.stack([_dot(view.across, view.lateral), _dot(view.across, view.sagittal)], -1)  # (F, 2)
    half = np.maximum(np.linalg.norm(widths * reach[:, None], axis=-1), TINY)  # (F, U)
    touch = widths**2 * reach[:, None] / half[..., None]  # (F, U, 2)
    contour = touch[..., :1] * view.lateral[:, None] + touch[..., 1:] * view.sagittal[:, None]
    axis = view.end - view.start
    centre = view.start[:, None] + u[:, None] * axis[:, None]
    world = centre[:, :, None] + v[:, None] * contour[:, :, None]  # (F, U, V, 3)
    cell = 2.0 / (ALONG * ACROSS)
    length = view.apparent_length[:, None]
    # d half = touch · d reach; d length = ω · (axis × along).
    half_rate = touch @ _reach_rate(view, axis)  # (F, U, 3)
    length_rate = np.cross(axis, view.along)[:, None]
    rate = cell * (length_rate * half[..., None] + length[..., None] * half_rate)
    return (
        world.reshape(len(world), -1, 3),
        np.repeat(cell * length * half, ACROSS, axis=1),
        np.repeat(rate, ACROSS, axis=1),
    )


def _reach_rate(view: View, axis: Array) -> Array:
    """(F, 2, 3) d (across · lateral, across · sagittal) / d angular velocity.

    Turning a foreshortened axis also turns its image, and with it the direction across.
    """
    image_turn = np.cross(axis, view.across) / np.maximum(view.apparent_length, 1e-4)[:, None]
    rows = [
        np.cross(side, view.across) - image_turn * _dot(view.along, side)[:, None]
        for side in (view.lateral, view.sagittal)
    ]
    return np.stack(rows, axis=1)


def _cap(centre: Array, widths: Array, sign: float, view: View) -> tuple[Array, Array, Array]:
    """Samples of the half of an elliptical end that shows beyond the contour lines, areas and rates."""
    outward = np.stack(
        [widths[0] * _dot(view.along, view.lateral), widths[1] * _dot(view.along, view.sagittal)], -1
    )
    pole, _ = _normalise(sign * outward, np.broadcast_to([1.0, 0.0], outward.shape))
    side = np.stack([-pole[:, 1], pole[:, 0]], -1)
    radius = np.sqrt((np.arange(RINGS) + 0.5) / RINGS)
    angle = (np.arange(SPOKES) + 0.5) / SPOKES * np.pi
    disc = (radius[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], -1)).reshape(-1, 2)
    flat = disc[:, :1] * side[:, None] + disc[:, 1:] * pole[:, None]  # (F, C, 2)
    world = (
        centre[:, None]
        + flat[..., :1] * widths[0] * view.lateral[:, None]
        + flat[..., 1:] * widths[1] * view.sagittal[:, None]
    )
    # The end's plane shows by the cosine between its normal and the view.
    normal = np.cross(view.lateral, view.sagittal)
    cosine = _dot(normal, view.toward)[:, None]
    full = 0.5 * np.pi * widths[0] * widths[1] / len(disc)
    rate = full * np.sign(cosine) * np.cross(normal, view.toward)
    shape = world.shape[:-1]
    return (
        world,
        np.array(np.broadcast_to(full * np.abs(cosine), shape)),
        np.array(np.broadcast_to(rate[:, None], (*shape, 3))),
    )
