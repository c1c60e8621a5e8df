"""What a picture shows of the camera that took it: lines of buildings, and upright things of known length."""

from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from .camera import Camera
from .camera_fields import heading_rad

CLICK_STD_PX = 1.5  # standard deviation of a click, or of a line's end drawn by hand [px]
COMMON_LEAN_RAD = float(np.radians(2.5))
"""Lean that one person has at all moments alike: heads lie in front of ankles, and walkers lean forward."""
STATURE_STD = 0.015  # share by which stated statures are off: shoes, hair, and what people say


NO_LINES = partial(np.zeros, (0, 2, 2))


@dataclass(frozen=True, eq=False)
class Uprights:
    """N upright things of known length that stand on the floor, or a performer at N moments."""

    lower_px: Array  # (N, 2) the lower point in the picture [px]
    upper_px: Array  # (N, 2) the point above it [px]
    lower_m: Array  # (N,) height of the lower point above the floor [m]
    length_m: Array  # (N,) length between the two [m]
    pixel_std: Array  # (N,) standard deviation of a point in the picture [px]
    length_std: Array  # (N,) share by which each length may be off
    lean_std_rad: Array  # (N,) lean to the side
    common_std: float = 0.0  # share by which all lengths may be off together
    common_lean_rad: float = 0.0  # lean that all may have together, as somebody who walks to one side has
    doubtful: bool = False  # whether single ones may be far off, as where nobody has looked at them

    @classmethod
    def none(cls) -> "Uprights":
        """None at all."""
        points, numbers = np.zeros((0, 2)), np.zeros(0)
        return cls(points, points, numbers, numbers, numbers, numbers, numbers)

    @classmethod
    def persons(cls, ground_px: ArrayLike, crown_px: ArrayLike, stature_m: float) -> "Uprights":
        """Someone of a stature [m] at N places, clicked on the floor between the feet and on the crown."""
        built = cls.things(ground_px, crown_px, stature_m)
        return replace(
            built,
            # In every step heads rise and fall by 3 %, and walkers lean to any side.
            length_std=np.full(len(built), 0.02),
            lean_std_rad=np.full(len(built), np.radians(3.0)),
            common_std=STATURE_STD,
            common_lean_rad=COMMON_LEAN_RAD,
        )

    @classmethod
    def things(cls, lower_px: ArrayLike, upper_px: ArrayLike, length_m: ArrayLike) -> "Uprights":
        """Things of known lengths (N,) [m] that stand on the floor, as doors, by their ends (N, 2) [px]."""
        lower = np.array(lower_px, dtype=np.float64).reshape(-1, 2)
        upper = np.array(upper_px, dtype=np.float64).reshape(-1, 2)
        ones = np.ones(len(lower))
        # They were built upright, and measured.
        stds = CLICK_STD_PX * ones, 0.005 * ones, np.radians(0.5) * ones
        return cls(lower, upper, 0.0 * ones, np.asarray(length_m, dtype=np.float64) * ones, *stds)

    def __len__(self) -> int:
        return len(self.lower_px)

    def __add__(self, other: "Uprights") -> "Uprights":
        """Both together; what may be off in common is taken to be the same of both."""
        if not len(self) or not len(other):
            return self if len(self) else other
        arrays: dict[str, Any] = {
            name: np.concatenate([own, getattr(other, name)])
            for name, own in vars(self).items()
            if isinstance(own, np.ndarray)
        }
        return Uprights(
            **arrays,
            common_std=max(self.common_std, other.common_std),
            common_lean_rad=max(self.common_lean_rad, other.common_lean_rad),
            doubtful=self.doubtful or other.doubtful,
        )


@dataclass(frozen=True, eq=False)
class RoomView:
    """The camera that a room's lines show, found without anybody who draws them."""

    tilt_rad: float
    roll_rad: float
    focal_px: float
    covariance: Array  # (3, 3) of tilt and roll [rad] and of the logarithm of the focal length
    share: float  # of the edges' length that runs in the room's directions


@dataclass(frozen=True, eq=False)
class CameraEvidence:
    """Lines in the picture by their two ends [px], upright things of known length, what a room shows."""

    vertical: Array = field(default_factory=NO_LINES)  # (V, 2, 2) plumb: door frames, corners of walls
    along: Array = field(default_factory=NO_LINES)
    """(A, 2, 2) level and parallel to each other in the world: on the floor, or on a wall."""
    across: Array = field(default_factory=NO_LINES)  # (C, 2, 2) level and at right angles to those
    uprights: Uprights = field(default_factory=Uprights.none)
    room: RoomView | None = None


REACH_M = 8  # lines lie so far to each side of the floor's part that is looked at
AHEAD_M = 4.0  # distance of that part at most: a whole person fits the picture there
PIECES = 4  # pieces of a meter, each straight, as a lens with distortion bends lines
MARGIN = 0.1  # share of the picture beyond which nothing is drawn, as distortion is not defined there
HORIZON_DEGREES = 60.0


@dataclass(frozen=True, eq=False)
class FloorGrid:
    """Straight pieces of lines in the picture, each from one point to another [px]."""

    lines: Array  # (S, 2, 2) of the grid
    depth_m: Array  # (S,) distance of each from the camera, along the viewing axis [m]
    horizon: Array  # (H, 2, 2) where the floor would end


def floor_grid(camera: Camera, frame: int | None = None) -> FloorGrid:
    """The grid of whole meters on the floor z = 0, about where the camera looks."""
    rotation, location = camera.pose(frame)
    ahead, reach = -rotation[:, 2], AHEAD_M
    if ahead[2] < 0.0 < location[2]:  # where it looks at the floor
        reach = min(location[2] * float(np.hypot(ahead[0], ahead[1])) / -float(ahead[2]), AHEAD_M)
    middle = np.round(location[:2] + reach * _level(rotation))
    steps = np.arange(-REACH_M, REACH_M + 1, dtype=np.float64)
    along = np.arange(-REACH_M * PIECES, REACH_M * PIECES + 1) / PIECES
    first, second = np.meshgrid(steps, along, indexing="ij")
    flat = np.zeros((2, *first.shape, 3))
    flat[0, ..., 0], flat[0, ..., 1] = middle[0] + first, middle[1] + second
    flat[1, ..., 0], flat[1, ..., 1] = middle[0] + second, middle[1] + first
    pixel, depth = camera.project(flat, frame)
    pieces = np.stack([pixel[:, :, :-1], pixel[:, :, 1:]], axis=-2).reshape(-1, 2, 2)
    nearer = np.minimum(depth[:, :, :-1], depth[:, :, 1:]).ravel()
    shown = _in_picture(camera, pieces)
    x, y = _level(rotation)
    angles = np.radians(np.linspace(-HORIZON_DEGREES, HORIZON_DEGREES, 48 + 1))
    cos, sin = np.cos(angles), np.sin(angles)
    far = np.stack([x * cos - y * sin, x * sin + y * cos, 0.0 * angles], axis=-1)
    edge, _ = camera.project(location + 1e5 * far, frame)
    horizon = np.stack([edge[:-1], edge[1:]], axis=-2)
    return FloorGrid(pieces[shown], nearer[shown], horizon[_in_picture(camera, horizon)])


def _level(rotation: Array) -> Array:
    """(2,) unit direction over the floor in which a camera looks."""
    heading = heading_rad(rotation)
    return np.array([-np.sin(heading), np.cos(heading)])


def _in_picture(camera: Camera, pieces: Array) -> Array:
    """(S,) whether both ends of pieces (S, 2, 2) lie in the picture or a little outside."""
    size = np.array(camera.resolution, dtype=np.float64)
    with np.errstate(invalid="ignore"):
        within = (pieces >= -MARGIN * size) & (pieces <= (1.0 + MARGIN) * size)
    return np.asarray(within.all(axis=(-2, -1)))
