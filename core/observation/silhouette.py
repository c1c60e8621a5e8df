"""The silhouette of tapered elliptical cylinders, as weighted sample points.

Samples fill the silhouette between the two contour lines, and the elliptical ends. Each is a point of
the solid: a contour line touches the surface where the cross-section reaches farthest across the view,
so moving the samples rigidly with the segment moves the silhouette correctly to first order.

Arrays lead with F frames and Q pieces.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray
from ..body.body_volume import PieceStack
from ..body.kinematics import Pose
from ..body.rotations import cross
from ..footage.camera import Camera

ALONG, ACROSS = 8, 4
RINGS, SPOKES = 2, 5
TINY = 1e-9

_U = (np.arange(ALONG) + 0.5) / ALONG
_V = (np.arange(ACROSS) + 0.5) / ACROSS * 2.0 - 1.0
# A product with a constant matrix repeats each of the U cross-sections for its row of samples.
_ALIKE, _SPREAD = np.repeat(np.eye(ALONG), ACROSS, axis=1), np.kron(np.eye(ALONG), _V)  # (U, S)
_RADIUS = np.sqrt((np.arange(RINGS) + 0.5) / RINGS)
_ANGLE = (np.arange(SPOKES) + 0.5) / SPOKES * np.pi
_DISC = (_RADIUS[:, None] * np.stack([np.cos(_ANGLE), np.sin(_ANGLE)])[:, None]).reshape(2, -1)


@dataclass(frozen=True, eq=False)
class View:
    """Viewing geometry of pieces in world axes: (F, Q, 3), or (F, Q) for lengths."""

    start: Array
    end: Array
    toward: Array
    """Viewing direction, away from the camera."""
    across: Array
    """Unit direction across both the view and the axis."""
    along: Array
    """Unit direction of the axis, across the view."""
    apparent_length: Array
    """Length of the axis across the view [m]."""
    lateral: Array
    sagittal: Array

    def reach(self, direction: Array) -> Array:
        """(F, Q, 2) cosines of a direction with the cross-section's axes."""
        return np.stack([_dot(direction, self.lateral), _dot(direction, self.sagittal)], axis=-1)


@dataclass(frozen=True, eq=False)
class Silhouette:
    """Sample points of the pieces' silhouettes."""

    world: Array
    """(F, Q, S, 3) [m]."""
    area: Array
    """(F, Q, S) share of the silhouette [m², across the view]."""
    area_rate: Array
    """(F, Q, S, 3) d area / d angular velocity in world axes [m² per rad]: foreshortening."""


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("...i,...i->...", a, b))


def _unit(vector: Array) -> tuple[Array, Array]:
    length = np.sqrt(_dot(vector, vector))
    return vector / np.maximum(length, TINY)[..., None], length


def view_pieces(pieces: PieceStack, pose: Pose, camera: Camera, frame: IndexArray) -> View:
    """Viewing geometry of each piece in each frame."""
    start, end = pieces.place(pose, pieces.start), pieces.place(pose, pieces.end)
    matrix = camera.matrix_world[frame][:, None] if camera.is_moving else camera.matrix_world
    toward, _ = _unit(0.5 * (start + end) - matrix[..., :3, 3])
    lateral, sagittal = pieces.turn(pose, pieces.lateral), pieces.turn(pose, pieces.sagittal)
    axis = end - start
    along, length = _unit(axis - _dot(axis, toward)[..., None] * toward)
    # Seen end on, the axis has no direction across the view: take the piece's lateral one.
    spare, _ = _unit(lateral - _dot(lateral, toward)[..., None] * toward)
    along = np.where(length[..., None] > 1e-6, along, spare)
    return View(start, end, toward, cross(toward, along), along, length, lateral, sagittal)


def sample_silhouette(pieces: PieceStack, view: View) -> Silhouette:
    """Samples of the pieces' silhouettes."""
    parts = [_wall(pieces.half_widths, view), *(_cap(pieces.half_widths, end, view) for end in (0, 1))]
    points, area, rate = (np.concatenate(rows, axis=-1) for rows in zip(*parts, strict=True))
    axes = np.stack([view.start, view.end - view.start, view.lateral, view.sagittal], axis=-1)
    return Silhouette(np.swapaxes(axes @ points, -1, -2), area, np.swapaxes(rate, -1, -2))


def _wall(half_widths: Array, view: View) -> tuple[Array, Array, Array]:
    """Samples between the contour lines: points (F, Q, 4, S), areas (F, Q, S), area rates (F, Q, 3, S).

    A point has four coordinates: one, the share of the axis, and meters along the cross-section's axes.
    """
    widths = half_widths[:, 0, :, None] + _U * (half_widths[:, 1] - half_widths[:, 0])[..., None]  # (Q, 2, U)
    stretched = widths * view.reach(view.across)[..., None]  # (F, Q, 2, U)
    half = np.maximum(np.hypot(stretched[:, :, 0], stretched[:, :, 1]), TINY)[:, :, None]  # (F, Q, 1, U)
    touch = widths * stretched / half
    axis = view.end - view.start
    cell = 2.0 / (ALONG * ACROSS)
    length = view.apparent_length[..., None, None]
    # d half = touch · d reach; d length = ω · (axis × along).
    half_rate = np.swapaxes(_reach_rate(view, axis), -1, -2) @ touch  # (F, Q, 3, U)
    rate = cell * (cross(axis, view.along)[..., None] * half + length * half_rate)
    points = np.empty((*touch.shape[:2], 4, ALONG * ACROSS))
    points[:, :, 0], points[:, :, 1] = 1.0, _U @ _ALIKE
    np.matmul(touch, _SPREAD, out=points[:, :, 2:])
    return points, ((cell * length * half) @ _ALIKE)[:, :, 0], rate @ _ALIKE


def _reach_rate(view: View, axis: Array) -> Array:
    """(F, Q, 2, 3) d (across · lateral, across · sagittal) / d angular velocity.

    Turning a foreshortened axis also turns its image, and with it the direction across.
    """
    image_turn = cross(axis, view.across) / np.maximum(view.apparent_length, 1e-4)[..., None]
    rows = [
        cross(side, view.across) - image_turn * _dot(view.along, side)[..., None]
        for side in (view.lateral, view.sagittal)
    ]
    return np.stack(rows, axis=2)


def _cap(half_widths: Array, end: int, view: View) -> tuple[Array, Array, Array]:
    """Like `_wall`, for the half of the first or last elliptical end beyond the contour lines."""
    widths = half_widths[:, end]
    pole, length = _unit((1.0 if end else -1.0) * widths * view.reach(view.along))
    pole = np.where(length[..., None] > 1e-6, pole, np.array([1.0, 0.0]))
    side = np.stack([-pole[..., 1], pole[..., 0]], axis=-1)
    points = np.empty((*pole.shape[:2], 4, _DISC.shape[1]))
    points[:, :, 0], points[:, :, 1] = 1.0, end
    np.matmul(np.stack([side, pole], axis=-1) * widths[..., None], _DISC, out=points[:, :, 2:])
    # The end's disc is foreshortened by the cosine between its normal and the view.
    normal = cross(view.lateral, view.sagittal)
    cosine = _dot(normal, view.toward)[..., None]
    full = 0.5 * np.pi * widths[:, :1] * widths[:, 1:] / _DISC.shape[1]  # (Q, 1)
    rate = full * np.sign(cosine) * cross(normal, view.toward)
    shape = (*pole.shape[:2], 3, _DISC.shape[1])
    return (
        points,
        np.broadcast_to(full * np.abs(cosine), (*shape[:2], shape[3])),
        np.broadcast_to(rate[..., None], shape),
    )
