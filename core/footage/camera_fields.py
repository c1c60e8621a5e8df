"""Validation of a camera's fields in a take: each mistake is an `InputError` of one sentence."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..files.fields import Fields
from ..files.inherited_fields import PLACED
from ..files.json_file import shown
from ..files.number_lists import number_array
from .camera_placement import CameraPlacement

LARGEST_SIDE_PX = 2**16
MOST_DISTORTION = 100.0
"""Largest coefficient; those of real lenses are below 1."""
FARTHEST_M = 1e6
"""Largest entry of a pose: distance from the origin along an axis, or scale."""
FACING = "distance_m"
"""Says where the world's origin is, which is of no use without the rest."""
MATRICES = ("matrix_world", "matrix_world_frames")
HEIGHTS_M = (0.01, 1000.0)
"""A camera's height above the floor lies between these [m]."""
SMALLEST_SCALE = 1e-4
ROTATION_TOLERANCE = 1e-3
"""Files written by hand or in single precision have errors of about 1e-6."""


def read_resolution(fields: Fields) -> tuple[int, int]:
    """Read the image's width and height in pixels.

    Raises:
        InputError: The field is absent or not two whole numbers from 1 to 65536.
    """
    valid = f"two whole numbers from 1 to {LARGEST_SIDE_PX}, width and height in pixels"
    numbers = number_array(fields.required("resolution", valid))
    fits = numbers is not None and numbers.shape == (2,) and not np.any(numbers % 1)
    if numbers is None or not fits or numbers.min() < 1 or numbers.max() > LARGEST_SIDE_PX:
        shown_value = shown(fields.values["resolution"])
        raise InputError(f"{fields.source_of('resolution')}: resolution is {shown_value}; it must be {valid}")
    return int(numbers[0]), int(numbers[1])


def read_distortion(fields: Fields) -> tuple[float, float, float]:
    """Read k1, k2, k3 of the polynomial distortion; without the field there is none, missing ones are 0.

    Raises:
        InputError: The field is neither a list of at most three numbers nor an object with k1, k2, k3, or a
            coefficient is out of range.
    """
    value = fields.values.get("distortion")
    if value is None:
        return (0.0, 0.0, 0.0)
    listed: Any = value
    if isinstance(value, Mapping) and set(value) <= {"k1", "k2", "k3"}:
        listed = [value.get(name, 0.0) for name in ("k1", "k2", "k3")]
    numbers = number_array(listed)
    if numbers is None or numbers.ndim != 1 or numbers.size > 3 or np.any(np.abs(numbers) > MOST_DISTORTION):
        raise InputError(
            f"{fields.source_of('distortion')}: distortion is {shown(value)}; "
            f"it must be up to three numbers [k1, k2, k3], each within {MOST_DISTORTION:g}"
        )
    padded = np.zeros(3)
    padded[: numbers.size] = numbers
    return float(padded[0]), float(padded[1]), float(padded[2])


def read_poses(fields: Fields) -> Array:
    """Read the camera's pose (4, 4), or (F, 4, 4) where `matrix_world_frames` gives one a frame.

    A uniform scale, as Blender's camera objects may have, is removed: it does not change the image. Instead
    of a matrix a still camera may have its height, tilt and roll.

    Raises:
        InputError: A matrix is absent, of the wrong shape, or not a rotation with a translation; a number is
            out of range, or there are both.
    """
    placed = [name for name in PLACED if fields.has(name) and name != FACING]
    if placed:
        return _read_placement(fields, placed[0])
    if not any(fields.has(name) for name in MATRICES):
        fields.required("matrix_world", "a 4 by 4 matrix of finite numbers; height_m and tilt_deg do as well")
    moving = fields.has("matrix_world_frames")
    poses = _read_poses(fields, "matrix_world_frames", "one 4 by 4 matrix a frame", 3) if moving else None
    if poses is not None and not fields.has("matrix_world"):
        return poses
    fixed = _read_poses(fields, "matrix_world", "a 4 by 4 matrix of finite numbers", 2)
    return fixed if poses is None else poses


def _read_placement(fields: Fields, given: str) -> Array:
    """Pose (4, 4) of a camera that looks along +Y at the world's origin, or stands above it."""
    for matrix in MATRICES:
        if fields.has(matrix):
            raise InputError(
                f"{fields.source_of(given)}: there are both {given} and {matrix}; give height_m, tilt_deg "
                "and roll_deg, or a matrix"
            )

    def degrees(name: str, most: float) -> float:
        return float(np.radians(fields.number(name, -most, most, "degrees"))) if fields.has(name) else 0.0

    height_m = fields.number("height_m", *HEIGHTS_M, "m")
    distance_m = fields.number("distance_m", 0.0, FARTHEST_M, "m") if fields.has("distance_m") else 0.0
    placement = CameraPlacement(height_m, degrees("tilt_deg", 90.0), degrees("roll_deg", 180.0))
    return placement.matrix((0.0, -distance_m))


def _read_poses(fields: Fields, name: str, valid: str, ndim: int) -> Array:
    matrices = number_array(fields.required(name, valid))
    if matrices is None or matrices.ndim != ndim or matrices.shape[-2:] != (4, 4) or not matrices.size:
        raise InputError(f"{fields.source_of(name)}: {name} has the wrong form; it must be {valid}")
    stacked = matrices.reshape(-1, 4, 4).copy()
    fault = _first_fault(stacked)
    if fault is not None:
        index, what = fault
        raise InputError(
            f"{fields.source_of(name)}: {name}" + (f"[{index}]" if ndim == 3 else "") + f" {what}"
        )
    left, _, right = np.linalg.svd(_scaled(stacked))
    stacked[:, :3, :3] = left @ right
    return stacked.reshape(matrices.shape)


def _first_fault(matrices: Array) -> tuple[int, str] | None:
    """Index of the first of (F, 4, 4) that is no pose, and the reason to follow its name."""
    last = np.abs(matrices[:, 3] - [0.0, 0.0, 0.0, 1.0]).max(axis=1) > ROTATION_TOLERANCE
    far = np.abs(matrices).max(axis=(1, 2)) > FARTHEST_M
    sound = np.where((last | far)[:, None, None], np.eye(4), matrices)
    determinants = np.linalg.det(sound[:, :3, :3])
    flat = determinants < SMALLEST_SCALE**3
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
