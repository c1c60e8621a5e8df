"""Where a camera stands and how it is held: height above the floor, tilt and roll.

Only these three and the lens say anything of the floor in the picture. The place on the floor and the heading
are a choice of the world's axes: they stay as they are.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, cos, hypot, sin
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..errors import InputError
from ..files.fields import PLACED, Fields
from ..files.kinds import Items, Kind, Number, Whole, number_array, refuse
from ..files.records import Record, read_record

STRAIGHT_DOWN = 1e-6  # horizontal share of a viewing direction below which it has no heading


@dataclass(frozen=True)
class CameraPlacement:
    """Height and attitude of a camera over the floor z = 0."""

    height_m: float  # above the floor [m]
    tilt_rad: float  # of the viewing direction above the horizon; negative where the camera looks down
    roll_rad: float
    """About the viewing direction, counterclockwise as the camera's operator sees it: the picture then leans
    clockwise."""

    @classmethod
    def of(cls, matrix_world: ArrayLike) -> "CameraPlacement":
        """The placement of a camera's pose (4, 4), camera to world."""
        matrix = np.asarray(matrix_world, dtype=np.float64)
        right, up, back = matrix[2, :3]  # the world's up in the camera's axes
        level = hypot(right, up)
        tilt = atan2(-back, level)
        if level < STRAIGHT_DOWN:  # without a heading there is no roll
            return cls(float(matrix[2, 3]), tilt, 0.0)
        return cls(float(matrix[2, 3]), tilt, atan2(right, up))

    def rotation(self, heading_rad: float = 0.0) -> Array:
        """The camera's orientation (3, 3), its axes as columns: turned about Z, tilted, rolled."""
        tilted, rolled = self.tilt_rad, self.roll_rad
        lift = np.array(
            [[1.0, 0.0, 0.0], [0.0, -sin(tilted), -cos(tilted)], [0.0, cos(tilted), -sin(tilted)]]
        )
        return np.asarray(_about_z(heading_rad) @ lift @ _about_z(rolled))

    def matrix(self, place: tuple[float, float] = (0.0, 0.0), heading_rad: float = 0.0) -> Array:
        """The pose (4, 4), camera to world, above a place on the floor [m], turned from looking along +Y."""
        pose = np.eye(4)
        pose[:3, :3] = self.rotation(heading_rad)
        pose[:3, 3] = *place, self.height_m
        return pose

    def applied_to(self, matrix_world: ArrayLike) -> Array:
        """A pose (4, 4) with this placement that keeps the heading and the place on the floor of another."""
        before = np.asarray(matrix_world, dtype=np.float64)
        return self.matrix((float(before[0, 3]), float(before[1, 3])), heading_rad(before))


def _about_z(angle: float) -> Array:
    return np.array([[cos(angle), -sin(angle), 0.0], [sin(angle), cos(angle), 0.0], [0.0, 0.0, 1.0]])


def heading_rad(matrix_world: ArrayLike) -> float:
    """Heading of a camera's pose (4, 4) or orientation (3, 3) about the world's Z, 0 along +Y [rad]."""
    matrix = np.asarray(matrix_world, dtype=np.float64)
    ahead = -matrix[:2, 2]
    if hypot(*ahead) < STRAIGHT_DOWN:  # what is up in the picture lies ahead on the floor, or behind
        ahead = matrix[:2, 1] * (1.0 if matrix[2, 2] > 0.0 else -1.0)
    return atan2(-float(ahead[0]), float(ahead[1]))


MOST_SHIFT = 100.0  # largest shift [image widths]
LARGEST_SIDE_PX = 2**16
MOST_DISTORTION = 100.0  # largest coefficient; those of real lenses are below 1
FARTHEST_M = 1e6  # largest entry of a pose: distance from the origin along an axis, or scale
FACING = "distance_m"  # says where the world's origin is, which is of no use without the rest
MATRICES = ("matrix_world", "matrix_world_frames")
HEIGHTS_M = (0.01, 1000.0)  # A camera's height above the floor lies between these [m]
ROTATION_TOLERANCE = 1e-3  # files written by hand or in single precision have errors of about 1e-6


class Pose(Kind):
    """A pose (4, 4), or several (F, 4, 4).

    A uniform scale, as Blender's camera objects may have, is removed: it does not change the image.
    """

    def __init__(self, *, several: bool) -> None:
        self.several = several
        self.valid = "one 4 by 4 matrix a frame" if several else "a 4 by 4 matrix of finite numbers"

    def read(self, value: Any, where: str, name: str) -> Array:
        """See `Kind`."""
        matrices = number_array(value)
        formed = matrices is not None and matrices.ndim == 2 + self.several and matrices.size > 0
        if matrices is None or not formed or matrices.shape[-2:] != (4, 4):
            raise InputError(f"{where}: {name} has the wrong form; it must be {self.valid}")
        stacked = matrices.reshape(-1, 4, 4).copy()
        fault = _first_fault(stacked)
        if fault is not None:
            index, what = fault
            raise InputError(f"{where}: {name}" + (f"[{index}]" if self.several else "") + f" {what}")
        left, _, right = np.linalg.svd(_scaled(stacked))
        stacked[:, :3, :3] = left @ right
        return stacked.reshape(matrices.shape)


class Distortion(Kind):
    """K1, k2, k3 of the polynomial distortion, in a list or by name; missing ones are 0."""

    valid = f"up to three numbers [k1, k2, k3], each within {MOST_DISTORTION:g}"
    names = ("k1", "k2", "k3")

    def read(self, value: Any, where: str, name: str) -> tuple[float, float, float]:
        """See `Kind`."""
        listed: Any = value
        if isinstance(value, Mapping) and set(value) <= set(self.names):
            listed = [value.get(each, 0.0) for each in self.names]
        numbers = number_array(listed)
        usable = numbers is not None and numbers.ndim == 1 and numbers.size <= 3
        if numbers is None or not usable or np.any(np.abs(numbers) > MOST_DISTORTION):
            refuse(where, name, value, self.valid)
        k1, k2, k3 = [*numbers.tolist(), 0.0, 0.0, 0.0][:3]
        return k1, k2, k3


LensNumber = Annotated[float, Number(0.1, 100_000.0, "mm")]
Shift = Annotated[float, Number(-MOST_SHIFT, MOST_SHIFT)]


@dataclass(frozen=True, eq=False)
class CameraFields(Record):
    """The camera that saw the performance.

    Blender's conventions: looking along its local -Z with +Y up, sensor fit horizontal, square pixels.
    """

    lens_mm: LensNumber
    """Focal length [mm]."""
    sensor_width_mm: LensNumber
    """Width of the sensor [mm]; it spans the picture's width."""
    resolution: Annotated[
        tuple[Annotated[int, Whole(1, LARGEST_SIDE_PX)], ...],
        Items("numbers", 2, 2, f"two whole numbers from 1 to {LARGEST_SIDE_PX}, width and height in pixels"),
    ]
    """Width and height of the clip's pictures [px]. Takes below a shoot.json may omit it."""
    shift_x: Shift = 0.0
    """Shift of the view to the right [picture widths]."""
    shift_y: Shift = 0.0
    """Shift of the view upward [picture widths]."""
    height_m: Annotated[float, Number(*HEIGHTS_M, "m")] | None = None
    """Height of a still camera above the floor [m]; with tilt_deg and roll_deg instead of a matrix."""
    tilt_deg: Annotated[float, Number(-90.0, 90.0, "degrees")] | None = None
    """Angle of the viewing direction above the horizon [degrees]; negative where the camera looks down; the
    default is 0."""
    roll_deg: Annotated[float, Number(-180.0, 180.0, "degrees")] | None = None
    """Turn about the viewing direction, counterclockwise as the camera's operator sees it [degrees]; the
    default is 0."""
    distance_m: Annotated[float, Number(0.0, FARTHEST_M, "m")] | None = None
    """Distance over the floor at which the camera faces the world's origin, along +Y [m]; the default is 0,
    above it."""
    matrix_world: Annotated[Array, Pose(several=False)] | None = None
    """Pose of a static camera. Four rows of four numbers, camera to world: a rotation, a position in meters,
    the last row [0, 0, 0, 1]. A uniform scale is removed."""
    matrix_world_frames: Annotated[Array, Pose(several=True)] | None = None
    """Poses of a moving camera, one a frame of the clip; takes precedence over matrix_world."""
    distortion: Annotated[tuple[float, float, float], Distortion()] = (0.0, 0.0, 0.0)
    """Polynomial radial distortion, k1, k2, k3: a point at the radius r from the axis (at unit depth) is seen
    at r (1 + k1 r² + k2 r⁴ + k3 r⁶)."""

    @classmethod
    def of(cls, fields: Fields) -> "CameraFields":
        """Read them, of which `matrix_world` or `height_m` must be there.

        Raises:
            InputError: A field is missing or invalid, or there are both.
        """
        placed = [name for name in PLACED if fields.has(name) and name != FACING]
        posed = [name for name in MATRICES if fields.has(name)]
        if placed and posed:
            raise InputError(
                f"{fields.source_of(placed[0])}: there are both {placed[0]} and {posed[0]}; give height_m, "
                "tilt_deg and roll_deg, or a matrix"
            )
        if placed:
            fields.required("height_m", f"a number from {HEIGHTS_M[0]:g} to {HEIGHTS_M[1]:g} m")
        elif not posed:
            valid = "a 4 by 4 matrix of finite numbers; height_m and tilt_deg do as well"
            fields.required("matrix_world", valid)
        return read_record(cls, fields)

    @property
    def pose(self) -> Array:
        """The pose (4, 4), or (F, 4, 4) where there is one a frame."""
        if self.height_m is None:
            return self.matrix_world if self.matrix_world_frames is None else self.matrix_world_frames  # type: ignore[return-value]
        turns = (float(np.radians(degrees or 0.0)) for degrees in (self.tilt_deg, self.roll_deg))
        return CameraPlacement(self.height_m, *turns).matrix((0.0, -(self.distance_m or 0.0)))


def _first_fault(matrices: Array) -> tuple[int, str] | None:
    """Index of the first of (F, 4, 4) that is no pose, and the reason to follow its name."""
    last = np.abs(matrices[:, 3] - [0.0, 0.0, 0.0, 1.0]).max(axis=1) > ROTATION_TOLERANCE
    far = np.abs(matrices).max(axis=(1, 2)) > FARTHEST_M
    sound = np.where((last | far)[:, None, None], np.eye(4), matrices)
    determinants = np.linalg.det(sound[:, :3, :3])
    flat = determinants < 1e-4**3
    rotations = _scaled(np.where(flat[:, None, None], np.eye(4), sound))
    error = np.abs(np.swapaxes(rotations, 1, 2) @ rotations - np.eye(3)).max(axis=(1, 2))
    faults = last | far | flat | (error > ROTATION_TOLERANCE)
    if not faults.any():
        return None
    index = int(faults.argmax())
    if last[index]:
        return index, f"has the last row {matrices[index, 3].tolist()}; it must be [0, 0, 0, 1]"
    if far[index]:
        largest = float(np.abs(matrices[index]).max())
        return index, f"holds a number of the size {largest:.3g}; each must be within {FARTHEST_M:g}"
    if flat[index]:
        return index, f"has the determinant {determinants[index]:.3g}; it must turn, not mirror or flatten"
    return index, (
        f"is sheared or scaled unevenly (off by {error[index]:.2g}); its axes must be orthogonal and equally "
        "long"
    )


def _scaled(matrices: Array) -> Array:
    """Upper left (F, 3, 3) of (F, 4, 4), each without its uniform scale."""
    linear = matrices[:, :3, :3]
    return np.asarray(linear / np.cbrt(np.linalg.det(linear))[:, None, None])
