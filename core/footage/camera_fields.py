"""Reading the camera's fields from a take, each with one clear sentence when it is unusable."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..files.fields import Fields
from ..files.json_file import shown

FloatArray = NDArray[np.float64]

_ROTATION_TOLERANCE = 1e-3  # files written by hand or in single precision carry about 1e-6


def read_resolution(fields: Fields) -> tuple[int, int]:
    """Return the image's width and height in pixels.

    Raises:
        InputError: the field is absent or not two whole numbers above 0.
    """
    valid = "two whole numbers above 0, width and height in pixels"
    numbers = _array(fields.required("resolution", valid))
    if numbers is None or numbers.shape != (2,) or np.any(numbers < 1) or np.any(numbers % 1):
        shown_value = shown(fields.values["resolution"])
        raise InputError(f"{fields.at('resolution')}: resolution is {shown_value}; it must be {valid}")
    return int(numbers[0]), int(numbers[1])


def read_distortion(fields: Fields) -> tuple[float, float, float]:
    """Return k1, k2, k3 of the polynomial distortion; absent means none, missing coefficients are 0.

    Raises:
        InputError: the field is neither a list of at most three numbers nor an object with k1, k2, k3.
    """
    value = fields.values.get("distortion")
    if value is None:
        return (0.0, 0.0, 0.0)
    listed: Any = value
    if isinstance(value, Mapping) and set(value) <= {"k1", "k2", "k3"}:
        listed = [value.get(name, 0.0) for name in ("k1", "k2", "k3")]
    numbers = _array(listed)
    if numbers is None or numbers.ndim != 1 or numbers.size > 3:
        raise InputError(
            f"{fields.at('distortion')}: distortion is {shown(value)}; "
            "it must be up to three numbers [k1, k2, k3]"
        )
    padded = np.zeros(3)
    padded[: numbers.size] = numbers
    return float(padded[0]), float(padded[1]), float(padded[2])


def read_poses(fields: Fields) -> FloatArray:
    """Return the camera's pose (4, 4), or (F, 4, 4) where `matrix_world_frames` gives one a frame.

    A uniform scale, as Blender's camera objects may carry, is taken out: it does not change what a camera
    sees.

    Raises:
        InputError: a matrix is absent, of the wrong shape, or not a rotation with a translation.
    """
    if fields.has("matrix_world_frames"):
        name, valid, ndim = "matrix_world_frames", "one 4 by 4 matrix a frame", 3
    else:
        name, valid, ndim = "matrix_world", "a 4 by 4 matrix of finite numbers", 2
    matrices = _array(fields.required(name, valid))
    if matrices is None or matrices.ndim != ndim or matrices.shape[-2:] != (4, 4) or not matrices.size:
        raise InputError(f"{fields.at(name)}: {name} has the wrong form; it must be {valid}")
    stacked = matrices.reshape(-1, 4, 4).copy()
    for index, matrix in enumerate(stacked):
        place = f"{fields.at(name)}: {name}" + (f"[{index}]" if ndim == 3 else "")
        matrix[:3, :3] = _rotation(matrix, place)
    return stacked.reshape(matrices.shape)


def _rotation(matrix: FloatArray, place: str) -> FloatArray:
    if np.abs(matrix[3] - [0.0, 0.0, 0.0, 1.0]).max() > _ROTATION_TOLERANCE:
        raise InputError(f"{place} has the last row {matrix[3].tolist()}; it must be [0, 0, 0, 1]")
    linear = matrix[:3, :3]
    determinant = float(np.linalg.det(linear))
    if determinant <= 0.0:
        raise InputError(
            f"{place} has the determinant {determinant:.3g}; it must turn, not mirror or flatten"
        )
    rotation = linear / np.cbrt(determinant)
    error = float(np.abs(rotation.T @ rotation - np.eye(3)).max())
    if error > _ROTATION_TOLERANCE:
        raise InputError(
            f"{place} is sheared or scaled unevenly (off by {error:.2g}); its axes must be orthogonal "
            "and equally long"
        )
    left, _, right = np.linalg.svd(rotation)
    return np.asarray(left @ right)


def _array(value: Any) -> FloatArray | None:
    """Return nested lists as an array of finite numbers, or None where they are something else."""
    try:
        array = np.asarray(value)
    except ValueError:  # ragged lists
        return None
    if array.dtype.kind not in "iuf":
        return None
    array = array.astype(np.float64)
    return array if np.all(np.isfinite(array)) else None
