"""A reference motion: a 3D motion of the same performance from elsewhere, as its file has it.

Axes, scale, place and time are its own (`estimate/reference_alignment` finds them); here everything has Z up.
"""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..arrays import Array
from ..body.human import HUMAN
from ..errors import InputError
from ..files.fields import listed
from ..files.json_file import ENDING
from ..files.paths import regular_file_size
from .evidence import MOST_FRAMES
from .motion import read_motion

REFERENCE_ENDINGS = (".csv", ENDING)
LARGEST_BYTES = 2**30
FARTHEST = 1e6  # of a coordinate, in the file's units


@dataclass(frozen=True, eq=False)
class ReferenceMotion:
    """The principal points of a motion of R frames."""

    points_m: Array  # (R, 13, 3) in the skeleton's order, about in meters, Z up; NaN where absent
    fps: float | None = None  # frames a second; None where the file does not say, for the clip's own
    file: str = ""  # for sentences

    def __post_init__(self) -> None:
        shape = self.points_m.shape
        if len(shape) != 3 or shape[1:] != (len(HUMAN.point_names), 3):
            raise ValueError(f"points must have the shape (R, 13, 3), not {shape}")


def read_reference(path: Path) -> ReferenceMotion:
    """Read a reference motion: a csv of MHR-70's points, or a motion.json.

    Raises:
        InputError: The file is none of these or damaged, or fewer than two of its frames have a performer.
    """
    ending = path.suffix.lower()
    if ending not in REFERENCE_ENDINGS:
        raise InputError(
            f"{path}: is no reference motion; it must end in {listed(REFERENCE_ENDINGS)}, a csv of MHR-70's "
            "points or a motion.json"
        )
    if ending == ENDING:
        motion = read_motion(path)
        reference = ReferenceMotion(motion.points, motion.fps, str(path))
    else:
        reference = ReferenceMotion(_mhr70(path), None, str(path))
    known = np.isfinite(reference.points_m).all(axis=(1, 2))
    if known.sum() < 2:
        raise InputError(f"{path}: a performer is in {int(known.sum())} of its frames; at least 2 are needed")
    return reference


# --- MHR-70: columns NAME_3DX, _3DY, _3DZ in camera axes, x right, y down, z away [m]; zeros are absent


def _mhr70(path: Path) -> Array:
    if regular_file_size(path, "a reference motion") > LARGEST_BYTES:
        raise InputError(f"{path}: is larger than a gigabyte; a reference motion must be smaller")
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = csv.reader(file)
            header = [name.strip() for name in next(rows, [])]
            wanted = [_columns(header, name, path) for name in HUMAN.point_names]
            places = [
                _row(row, len(header), wanted, path, number) for number, row in enumerate(rows, 2) if row
            ]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: cannot be read as a csv ({error})") from error
    if not 2 <= len(places) <= MOST_FRAMES:
        raise InputError(f"{path}: has {len(places)} frames; it must have 2 to {MOST_FRAMES}")
    points = np.array(places)
    points[(points == 0.0).all(axis=(1, 2))] = np.nan
    return np.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1)


def _columns(header: list[str], point: str, path: Path) -> list[list[int]]:
    """The columns of a point: of one place, or of two whose middle it is."""
    stem, dot, side = point.partition(".")
    sided = f"{'left' if side == 'L' else 'right'}_{stem}"
    columns = []
    for name in (sided,) if dot else ("left_ear", "right_ear"):
        own = [f"{name}_3D{axis}" for axis in "XYZ"]
        missing = [column for column in own if column not in header]
        if missing:
            raise InputError(
                f"{path}: has no column {missing[0]}; a csv of MHR-70's points has columns like nose_3DX, "
                "nose_3DY, nose_3DZ for each point"
            )
        columns.append([header.index(column) for column in own])
    return columns


def _row(row: list[str], width: int, wanted: list[list[list[int]]], path: Path, line: int) -> list[Array]:
    if len(row) != width:
        raise InputError(f"{path}: line {line} has {len(row)} columns; it must have {width} as the first one")
    try:
        values = np.array([float(cell) if cell.strip() else np.nan for cell in row])
    except ValueError as error:
        raise InputError(f"{path}: line {line}: {error}; it must have numbers alone") from error
    values[~(np.abs(values) < FARTHEST)] = np.nan
    return [np.mean([values[one] for one in columns], axis=0) for columns in wanted]
