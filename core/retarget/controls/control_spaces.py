"""Control spaces: in which space a control's channels turn and place it, found from a few random poses.

A control's pose is its own channels in a space that something else carries: a parent, through whatever bones
and constraints lie between, or nothing at all. Of random poses only the carrier's own shows the control's
space as one that does not change. What turns a control may be another one than what carries it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array
from ...body import rotations
from ...body.posture_fit import nearest_rotation

NOTHING = -1  # instead of the index of a control: the armature itself
RIGID = 1e-3  # residual [rad, or shares of the character's size] below which a space is rigid


@dataclass(frozen=True, eq=False)
class ControlSpace:
    """The space in which a control's channels act."""

    turner: int  # index of the control that turns it; NOTHING for none
    turn: Array  # (3, 3) the axes of its rotation channels, in those of its turner (of the armature)
    carrier: int  # index of the control that carries it; NOTHING for none
    origin: Array  # (3,) its place without location channels, in its carrier's axes from its carrier's head
    axes: Array  # (3, 3) takes its location channels to its carrier's axes
    residual_rad: float  # largest turn that the space does not explain
    residual: float  # largest distance that it does not explain, in the armature's units

    def placed_by_turner(self, origin: Array) -> "ControlSpace":
        """The space where the turner carries it at a place (3,) in its axes, and locations do nothing."""
        return replace(self, carrier=self.turner, origin=origin, axes=np.zeros((3, 3)), residual=0.0)

    @property
    def movable(self) -> bool:
        """Whether its location channels place it."""
        # Least length of the axes of location channels that do something.
        return bool(np.linalg.svd(self.axes, compute_uv=False)[-1] > 1e-3)


@dataclass(frozen=True, eq=False)
class PosedControls:
    """Controls as posed at random, in S samples; the first of them without any location."""

    channels: Array  # (S, C, 4, 4) each control's own rotation and location
    poses: Array  # (S, C, 4, 4) its pose in the armature's space; scale is ignored
    still: int  # number of samples without location channels, at least two; four more have some


def chosen(posed: PosedControls, indices: Sequence[int]) -> PosedControls:
    """Some of the controls."""
    rows = list(indices)
    return replace(posed, channels=posed.channels[:, rows], poses=posed.poses[:, rows])


def find_spaces(posed: PosedControls) -> tuple[ControlSpace, ...]:
    """The space of every control."""
    turns, places = unscaled(posed.poses[..., :3, :3]), posed.poses[..., :3, 3]
    axes = turns @ np.swapaxes(posed.channels[..., :3, :3], -1, -2)  # (S, C, 3, 3)
    inverse = np.swapaxes(turns, -1, -2)[:, :, None]
    # A control is turned by what its own rotation axes change least in the axes of,
    seen = inverse @ axes[:, None]  # (S, turner, control, 3, 3)
    turners = _least(_spread(seen, (-2, -1)), _spread(axes, (-2, -1)))
    # and carried by what its place without location changes least from.
    still = places[: posed.still]
    apart = still[:, None] - still[:, :, None]  # (still, carrier, control, 3)
    seen = (inverse[: posed.still] @ apart[..., None])[..., 0]
    carriers = _least(_spread(seen, (-1,)), _spread(still, (-1,)))
    spaces = []
    for control, (turner, carrier) in enumerate(zip(turners, carriers, strict=True)):
        own, place = axes[:, control], places[:, control]
        if turner != NOTHING:
            own = np.swapaxes(turns[:, turner], -1, -2) @ own
        turn, residual_rad = constant_turn(own)
        if carrier != NOTHING:
            way = (place - places[:, carrier])[..., None]
            place = (np.swapaxes(turns[:, carrier], -1, -2) @ way)[..., 0]
        origin = place[: posed.still].mean(axis=0)
        moved, shift = posed.channels[posed.still :, control, :3, 3], place[posed.still :] - origin
        location_axes = np.linalg.lstsq(moved, shift, rcond=1e-6)[0].T
        left = np.concatenate([place[: posed.still] - origin, shift - moved @ location_axes.T])
        residual = float(np.linalg.norm(left, axis=-1).max())
        spaces.append(ControlSpace(turner, turn, carrier, origin, location_axes, residual_rad, residual))
    return tuple(spaces)


def unscaled(matrices: Array) -> Array:
    """(..., 3, 3) with columns of length one."""
    return np.asarray(matrices / np.maximum(np.linalg.norm(matrices, axis=-2, keepdims=True), 1e-12))


def constant_turn(turns: Array) -> tuple[Array, float]:
    """The turn (3, 3) nearest to all of (S, 3, 3), and the largest angle to one of them [rad]."""
    mean = nearest_rotation(turns.mean(axis=0)[None])[0]
    return mean, float(np.linalg.norm(rotations.logarithm(mean.T @ turns), axis=-1).max())


def _spread(values: Array, axis: tuple[int, ...]) -> Array:
    """Largest distance from the mean over the samples, which lead."""
    return np.asarray(np.sqrt(((values - values.mean(axis=0)) ** 2).sum(axis=axis)).max(axis=0))


def _least(others: Array, nothing: Array) -> list[int]:
    """Row of the least of (C, C) but the diagonal in each column; NOTHING where (C,) is less."""
    others = others + np.where(np.eye(len(others), dtype=bool), np.inf, 0.0)
    row = others.argmin(axis=0)
    less = others[row, np.arange(len(row))] < nothing
    return [int(index) if taken else NOTHING for index, taken in zip(row, less, strict=True)]


def rigid_offset(leading: Array, following: Array) -> tuple[Array, float, float]:
    """The mean pose (4, 4) without scale of a following bone (S, 4, 4) in the axes of the leading one.

    With it come the largest turn [rad] and the largest distance [the poses' unit] by which a sample differs.
    """
    axes = np.swapaxes(unscaled(leading[:, :3, :3]), -1, -2)
    turn, turn_rad = constant_turn(axes @ unscaled(following[:, :3, :3]))
    places = (axes @ (following[:, :3, 3] - leading[:, :3, 3])[..., None])[..., 0]
    offset = np.eye(4)
    offset[:3, :3], offset[:3, 3] = turn, places.mean(axis=0)
    return offset, turn_rad, float(np.linalg.norm(places - offset[:3, 3], axis=-1).max())
