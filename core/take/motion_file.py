"""`motion.json`: writing a motion for other programs, and reading it."""

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from ..arrays import Array
from ..body.actor import Actor
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.posture_fields import posture_to_json, rounded
from ..errors import ConversionError, InputError
from ..files.fields import Fields
from ..files.json_file import read_json, shown, write_json
from ..files.number_lists import number_array
from .motion import Motion

SCHEMA_VERSION = 1
LARGEST_BYTES = 2**29
"""Two hours of motion: about 2 kB a frame."""
LARGEST_NUMBER = 1e15
"""Of coordinates, angles, times and covariances, in the file's units."""
MOST_DIAGNOSTICS = 100
SIGNIFICANT_DIGITS = 6
UPPER = (np.array([0, 0, 0, 1, 1, 2]), np.array([0, 1, 2, 1, 2, 2]))
"""Rows and columns of xx, xy, xz, yy, yz, zz: the upper triangle of a covariance matrix."""


def write_motion(motion: Motion, path: Path) -> None:
    """Write a motion as `motion.json`, atomically; the same motion gives the same bytes.

    Lengths are in meters and angles in radians, rounded to 1e-6; lists run over the frames of the clip.
    A method that has no covariance (all NaN) leaves `sigma_m` and `covariance_mm2` out.

    Args:
        motion: The motion, F frames.
        path: The file.

    Raises:
        ConversionError: A value of the motion is not finite, or the file cannot be written.
    """
    _check_finite(motion)
    names = motion.body.skeleton.point_names
    fields = {
        "schema_version": SCHEMA_VERSION,
        "fps": motion.fps,
        "frame_start": motion.frame_start,
        "frame_count": len(motion.time_s),
        "method": motion.method,
        "keyframes": [index + motion.frame_start for index in motion.keyframe_indices],
        "time_s": rounded(motion.time_s),
        "points": dict(zip(names, rounded(np.swapaxes(motion.points, 0, 1)), strict=True)),
        **(_uncertainty(motion) if _has_covariance(motion) else {}),
        "posture": posture_to_json(motion.posture),
        "actor": {"segments_m": dict(motion.body.actor.segments_m)},
        "diagnostics": {name: _significant(rows) for name, rows in sorted(motion.diagnostics.items())},
    }
    write_json(path, fields)


def read_motion(path: Path) -> Motion:
    """Read a motion that `write_motion` wrote.

    Raises:
        InputError: The file or a field is unusable; the sentence names it.
    """
    fields = Fields(read_json(path, LARGEST_BYTES), str(path))
    fields.check_version(SCHEMA_VERSION)
    count = fields.integer("frame_count", 1, 10**6)
    lengths = fields.child("actor", "an object with segments_m").child("segments_m", "an object of lengths")
    try:
        body = Body(Actor(lengths.values))
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    skeleton = body.skeleton
    frame_start = fields.integer("frame_start", -(10**7), 10**7)
    if fields.has("sigma_m"):
        _rows(fields, "sigma_m", skeleton.point_names, (count,))  # checked only: the covariance holds it too
    return Motion(
        body=body,
        fps=fields.number("fps", 1e-3, 1e4, "frames per second"),
        frame_start=frame_start,
        time_s=_array(fields.required("time_s", "a list of seconds"), (count,), f"{path}: time_s"),
        posture=Posture.from_vector(skeleton, _rows(fields, "posture", skeleton.dof_names, (count,)).T),
        points=np.moveaxis(_rows(fields, "points", skeleton.point_names, (count, 3)), 0, 1),
        point_covariance=_covariance(fields, skeleton.point_names, count),
        keyframe_indices=_keyframe_indices(fields, frame_start, count),
        method=fields.text("method", "the name of a method"),
        diagnostics=_diagnostics(fields),
    )


def _has_covariance(motion: Motion) -> bool:
    return not np.isnan(motion.point_covariance).all()


def _uncertainty(motion: Motion) -> dict[str, Any]:
    names = motion.body.skeleton.point_names
    covariance = 1e6 * motion.point_covariance[:, :, UPPER[0], UPPER[1]]  # (F, P, 6), meters² to millimeters²
    return {
        "sigma_m": dict(zip(names, rounded(motion.sigma_m.T), strict=True)),
        "covariance_mm2": dict(zip(names, _significant(np.swapaxes(covariance, 0, 1)), strict=True)),
    }


def _covariance(fields: Fields, names: tuple[str, ...], count: int) -> Array:
    covariance = np.full((count, len(names), 3, 3), np.nan)
    if fields.has("covariance_mm2"):
        upper = 1e-6 * np.moveaxis(_rows(fields, "covariance_mm2", names, (count, 6)), 0, 1)
        covariance[:, :, UPPER[0], UPPER[1]] = upper
        covariance[:, :, UPPER[1], UPPER[0]] = upper
    return covariance


def _check_finite(motion: Motion) -> None:
    arrays = {"points": motion.points, "posture": motion.posture.to_vector()}
    if _has_covariance(motion):
        arrays["covariance"] = motion.point_covariance
    for name, values in arrays.items():
        bad = ~np.isfinite(values.reshape(len(values), -1)).all(axis=1)
        if bad.any():
            frame = int(np.flatnonzero(bad)[0]) + motion.frame_start
            raise ConversionError(
                f"the {motion.method} estimate has no finite {name} at frame {frame} and "
                f"{int(bad.sum()) - 1} more frames; nothing was written"
            )


def _significant(values: Array) -> Any:
    """Nested lists of numbers rounded to six significant digits; null where a number is not finite."""
    array = np.asarray(values, dtype=np.float64)
    flat = [float(f"{x:.{SIGNIFICANT_DIGITS}g}") + 0.0 if np.isfinite(x) else None for x in array.ravel()]
    return np.array(flat, dtype=object).reshape(array.shape).tolist()


def _rows(fields: Fields, name: str, keys: tuple[str, ...], shape: tuple[int, ...]) -> Array:
    """The lists of an object as one array, (len(keys), *shape)."""
    child = fields.child(name, "an object of lists by name")
    rows = [child.required(key, f"a list of shape {shape}") for key in keys]
    return np.stack([_array(row, shape, f"{child.where}.{key}") for row, key in zip(rows, keys, strict=True)])


def _array(value: Any, shape: tuple[int, ...], where: str) -> Array:
    array = number_array(value)
    if array is None or array.shape != shape or not np.all(np.abs(array) <= LARGEST_NUMBER):
        raise InputError(
            f"{where} is {shown(value)}; it must be a list of numbers of shape {shape}, each within "
            f"{LARGEST_NUMBER:g}"
        )
    return array


def _keyframe_indices(fields: Fields, frame_start: int, count: int) -> tuple[int, ...]:
    frames = fields.required("keyframes", "a list of frames")
    first, last = frame_start, frame_start + count - 1
    if not isinstance(frames, list) or not all(
        type(frame) is int and first <= frame <= last for frame in frames
    ):
        raise InputError(
            f"{fields.where}: keyframes is {shown(frames)}; it must be a list of frames, {first} to {last}"
        )
    return tuple(frame - frame_start for frame in frames)


def _diagnostics(fields: Fields) -> Mapping[str, Array]:
    given = fields.child("diagnostics", "an object of lists by name").values
    if len(given) > MOST_DIAGNOSTICS:
        raise InputError(
            f"{fields.where}: diagnostics has {len(given)} lists; at most {MOST_DIAGNOSTICS} are read"
        )
    rows: dict[str, Array] = {}
    for name, value in given.items():
        array = number_array(value, nulls=True)
        if array is None:
            raise InputError(
                f"{fields.where}: diagnostics: {shown(name)} is {shown(value)}; it must be numbers or "
                "null, or lists of them"
            )
        rows[name] = array
    return MappingProxyType(rows)
