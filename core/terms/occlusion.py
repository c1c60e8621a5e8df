"""The silhouette of tapered elliptical cylinders, as weighted sample points.

Samples fill the silhouette between the two contour lines, and the elliptical ends. Each is a point of
the solid: a contour line touches the surface where the cross-section reaches farthest across the view,
so moving the samples rigidly with the segment moves the silhouette correctly to first order.

Arrays lead with F frames and Q pieces.
"""

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.body_volume import PieceStack
from ..body.kinematics import Pose
from ..body.rotations import cross
from ..camera.camera import Camera

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
    toward: Array  # viewing direction, away from the camera
    across: Array  # unit direction across both the view and the axis
    along: Array  # unit direction of the axis, across the view
    apparent_length: Array  # length of the axis across the view [m]
    lateral: Array
    sagittal: Array

    def reach(self, direction: Array) -> Array:
        """(F, Q, 2) cosines of a direction with the cross-section's axes."""
        return np.stack([_dot(direction, self.lateral), _dot(direction, self.sagittal)], axis=-1)


@dataclass(frozen=True, eq=False)
class Silhouette:
    """Sample points of the pieces' silhouettes."""

    world: Array  # (F, Q, S, 3) [m]
    area: Array  # (F, Q, S) share of the silhouette [m², across the view]
    area_rate: Array  # (F, Q, S, 3) d area / d angular velocity in world axes [m² per rad]: foreshortening


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


# --- Self-occlusion


DEPTH_SOFTNESS_M = 0.02
EDGE_SOFTNESS_PX = 0.7
HIDDEN_DEPTH_M = 0.01  # least depth difference of an occluding part: neighbors share their joint's depth
NEGLIGIBLE = 8.0  # softness widths beyond which a part's effect vanishes
BLOCK = 256  # pairs of a piece and a part at a time, whose samples fit in the cache


@dataclass(frozen=True, eq=False)
class PartOutlines:
    """Image outlines of the O parts that may occlude others, per frame; the last axis runs over both ends."""

    start: Array  # (F, O, 2) projection of the axis' first end [px]
    end: Array
    depth: Array  # (F, O, 2) camera depth of both ends [m]
    half_width: Array  # (F, O, 2) half-width of the outline at both ends [px]
    overshoot: Array  # (F, O, 2) extent of the outline past both ends, along the axis [px]

    def pick(self, frame: IndexArray, part: IndexArray) -> "PartOutlines":
        """Select R pairs of a frame and a part; the arrays become (R, 2)."""
        return PartOutlines(*(getattr(self, field.name)[frame, part] for field in fields(self)))


def part_outlines(parts: PieceStack, pose: Pose, camera: Camera, frame: IndexArray) -> PartOutlines:
    """The image outlines of all parts of the body."""
    view = view_pieces(parts, pose, camera, frame)
    start, start_depth = camera.project(view.start, frame[:, None])
    end, end_depth = camera.project(view.end, frame[:, None])
    depth = np.stack([start_depth, end_depth], -1)
    scale = camera.focal_px / np.maximum(depth, 1e-3)
    half, past = (
        np.linalg.norm(view.reach(direction)[:, :, None] * parts.half_widths, axis=-1) * scale
        for direction in (view.across, view.along)
    )
    return PartOutlines(start, end, depth, half, past)


def visible_share(pixels: Array, depth: Array, parts: PartOutlines, own: BoolArray) -> Array:
    """Visible share of each sample, 0 to 1.

    (F, Q, S) of samples `pixels` (F, Q, S, 2) at camera depths `depth` [m]; `own` (Q, O): whether a part
    belongs to the piece's own marker and cannot occlude it.
    """
    seen = np.ones(depth.shape)
    frame, piece, part = np.nonzero(_may_hide(pixels, depth, parts) & ~own)
    if not len(frame):
        return seen
    columns, rows = pixels[..., 0], pixels[..., 1]
    shown = np.empty((len(frame), depth.shape[-1]))
    for start in range(0, len(frame), BLOCK):
        block = slice(start, start + BLOCK)
        where = frame[block], piece[block]
        picked = parts.pick(frame[block], part[block])
        shown[block] = 1.0 - _hidden_share(columns[where], rows[where], depth[where], picked)
    first = np.flatnonzero(np.diff(frame * len(own) + piece, prepend=-1))  # of each piece in each frame
    seen[frame[first], piece[first]] = np.multiply.reduceat(shown, first, axis=0)
    return seen


def outline_depth(pixels: Array, parts: PartOutlines) -> Array:
    """Camera depth (F, N, O) [m] of each part's axis where it covers pixels (F, N, 2), else infinite."""
    start, axis = parts.start[:, None], (parts.end - parts.start)[:, None]  # (F, 1, O, 2)
    length = np.maximum(np.linalg.norm(axis, axis=-1), 1e-6)
    x, y = np.moveaxis(pixels[:, :, None] - start, -1, 0)
    across, down = np.moveaxis(axis / length[..., None], -1, 0)
    run = x * across + y * down
    away = y * across - x * down
    on_axis = np.clip(run, 0.0, length)
    share = on_axis / length

    def at(ends: Array) -> Array:
        return np.asarray(ends[:, None, :, 0] + share * (ends[:, None, :, 1] - ends[:, None, :, 0]))

    half = np.maximum(at(parts.half_width), 0.5)
    past = (run - on_axis) * half / np.maximum(at(parts.overshoot), 0.5)
    return np.where(away * away + past * past < half * half, at(parts.depth), np.inf)


def _may_hide(pixels: Array, depth: Array, parts: PartOutlines) -> BoolArray:
    """(F, Q, O) whether a part's outline comes near a piece's bounding circle, and lies nearer in depth."""
    columns, rows = pixels[..., 0], pixels[..., 1]
    left, right, top, bottom = columns.min(-1), columns.max(-1), rows.min(-1), rows.max(-1)
    radius = 0.5 * np.hypot(right - left, bottom - top)
    # The nearest point of the part's axis to the circle's center.
    across, down = np.moveaxis((parts.end - parts.start)[:, None], -1, 0)  # (F, 1, O)
    first_x, first_y = np.moveaxis(parts.start[:, None], -1, 0)
    dx = 0.5 * (left + right)[..., None] - first_x  # (F, Q, O)
    dy = 0.5 * (top + bottom)[..., None] - first_y
    share = np.clip((dx * across + dy * down) / np.maximum(across**2 + down**2, 1e-6), 0.0, 1.0)
    dx, dy = dx - share * across, dy - share * down
    extent = np.maximum(parts.half_width, parts.overshoot).max(axis=-1)
    reach = radius[:, :, None] + extent[:, None] + NEGLIGIBLE * EDGE_SOFTNESS_PX
    close = dx**2 + dy**2 < reach**2
    margin = HIDDEN_DEPTH_M - NEGLIGIBLE * DEPTH_SOFTNESS_M
    return np.asarray(close & (parts.depth.min(-1)[:, None] + margin < depth.max(2)[:, :, None]))


def _hidden_share(columns: Array, rows: Array, depth: Array, part: PartOutlines) -> Array:
    """Occluded share of samples (R, S) behind one part each, in R selected frames."""
    axis = part.end - part.start
    squared = np.maximum((axis * axis).sum(-1, keepdims=True), 1e-12)
    along = axis / squared
    away_from = axis * (0.5 / EDGE_SOFTNESS_PX / np.sqrt(squared))
    # All lengths are in half softness widths from here on, the unit of the logistic.
    half = np.maximum(part.half_width, 0.5) * (0.5 / EDGE_SOFTNESS_PX)
    stretch = half / np.maximum(part.overshoot, 0.5) * np.sqrt(squared)
    axis_depth = (part.depth + HIDDEN_DEPTH_M) * (0.5 / DEPTH_SOFTNESS_M)

    share = _affine(columns, rows, along[:, :1], along[:, 1:], part.start)
    away = _affine(columns, rows, -away_from[:, 1:], away_from[:, :1], part.start)
    on_axis = np.clip(share, 0.0, 1.0)
    share -= on_axis  # past either end, where `on_axis` is 0 or 1
    share *= _between(stretch, on_axis)
    share *= share
    away *= away
    away += share
    inside = _between(half, on_axis)
    inside -= np.sqrt(away, out=away)
    nearer = depth * (0.5 / DEPTH_SOFTNESS_M)
    nearer -= _between(axis_depth, on_axis)
    hidden = _logistic_of_half(inside)
    hidden *= _logistic_of_half(nearer)
    return hidden


def _affine(columns: Array, rows: Array, right: Array, down: Array, origin: Array) -> Array:
    """Affine function of image points (R, S) with slopes (R, 1) that vanishes at `origin` (R, 2)."""
    value = columns * right
    value += rows * down
    value -= origin[:, :1] * right + origin[:, 1:] * down
    return value


def _between(ends: Array, share: Array) -> Array:
    value = share * (ends[:, 1:] - ends[:, :1])
    value += ends[:, :1]
    return value


def _logistic_of_half(x: Array) -> Array:
    """1 / (1 + exp(-2x)) in place, by the hyperbolic tangent, which cannot overflow and is fast."""
    np.tanh(x, out=x)
    x += 1.0
    x *= 0.5
    return x


# --- The picture's edge


SMALLEST_CELL_PX = 1.0
SMALLEST_SHARE = 1e-6


class EdgeCut(NamedTuple):
    """What the picture's edge leaves of samples (...)."""

    share: Array  # (...) share within the picture, 0 to 1
    slope: Array  # (..., 2) d log share / d pixel [1/px]; zero where all or nothing is left


def near_edge(pixels: Array, area: Array, size: tuple[int, int]) -> BoolArray:
    """(F, Q) which pieces the edge of a picture (columns, rows) cuts, or leaves out.

    `pixels` (F, Q, S, 2): the pieces' samples; `area` (F, Q, S) of the cells they stand for [px²].
    """
    reach = 0.5 * np.sqrt(np.maximum(area.max(axis=-1), SMALLEST_CELL_PX**2))
    outside = np.zeros(area.shape[:2], dtype=np.bool_)
    for axis in (0, 1):
        along = pixels[..., axis]
        outside |= (along.min(axis=-1) < reach) | (along.max(axis=-1) > size[axis] - reach)
    return outside


def edge_cut(pixels: Array, area: Array, size: tuple[int, int]) -> EdgeCut:
    """What the edge of a picture leaves of square cells.

    `pixels` (..., 2): their centers; `area` (...) [px²]; `size`: columns and rows of the picture.
    """
    side = np.sqrt(np.maximum(area, SMALLEST_CELL_PX**2))
    share, slope = np.ones(area.shape), np.zeros(pixels.shape)
    for axis in (0, 1):
        along = pixels[..., axis]
        for away, sign in ((along, 1.0), (size[axis] - along, -1.0)):
            within = np.clip(0.5 + away / side, 0.0, 1.0)
            cut = (within > SMALLEST_SHARE) & (within < 1.0)
            slope[..., axis] += np.where(cut, sign / (side * np.maximum(within, SMALLEST_SHARE)), 0.0)
            share = share * within
    return EdgeCut(share, np.where(share[..., None] > 0.0, slope, 0.0))
