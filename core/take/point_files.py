"""Files of motions: points in space (csv and npy of FreeMoCap, other csv, TRC, C3D), and BVH.

Points are found by their names, up is the axis along which the head is above the ankles, and where a file
does not tell its unit it is the one that makes a person of it.
"""

import csv
import io
import re
import warnings
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import MOST_FRAMES
from ..arrays import Array
from ..body.human import HUMAN
from ..errors import InputError, describe_unexpected, shown
from ..files.json_file import write_atomically
from ..files.paths import read_saved_text, regular_file_size, with_decimal_point
from .named_points import MHR_UP, PointTable, chosen_subject, one_subject, principal_points

LARGEST_BYTES = 2**30
MOST_POINTS = 10_000
FARTHEST = 1e6  # of a coordinate, in the file's units
SLOWEST, FASTEST = 1.0, 1000.0  # frames a second
UNITS_M = {"m": 1.0, "meters": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254, "inches": 0.0254}
SHORTEST_LEG_M, LONGEST_LEG_M = 0.35, 1.5  # of a child and of a giant
MEDIAPIPE = (
    *("nose", "left_eye_inner", "left_eye", "left_eye_outer", "right_eye_inner", "right_eye"),
    *("right_eye_outer", "left_ear", "right_ear", "mouth_left", "mouth_right", "left_shoulder"),
    *("right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist", "left_pinky"),
    *("right_pinky", "left_index", "right_index", "left_thumb", "right_thumb", "left_hip", "right_hip"),
    *("left_knee", "right_knee", "left_ankle", "right_ankle", "left_heel", "right_heel"),
    *("left_foot_index", "right_foot_index"),
)
"""The points of MediaPipe's pose in its order, which FreeMoCap's npy has without names."""
_AXIS = re.compile(r"[\s_.:]*(?:3D)?([XYZxyz])$")
UPRIGHT = {
    (0, 1): ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
    (0, -1): ((0, 1, 0), (0, 0, -1), (-1, 0, 0)),
    (1, 1): ((1, 0, 0), (0, 0, -1), (0, 1, 0)),
    (1, -1): ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
    (2, 1): ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    (2, -1): ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
}
"""Rotations that make an axis of a sign Z."""


def read_points(path: Path, subject: str | None = None) -> tuple[Array, float | None, tuple[str, ...]]:
    """The 13 points (F, 13, 3) [m], Z up, NaN where absent, frames a second where the file tells, and notes.

    Where names have prefixes, as in Anna:LKnee, the points are those of one: the subject's, or else of the
    prefix that has all of them in the most frames.

    Raises:
        InputError: The file is damaged, lacks points, has no such subject, or no size of a person.
    """
    if regular_file_size(path, "a file of points") > LARGEST_BYTES:
        raise InputError(f"{path}: is larger than a gigabyte; a motion must be smaller")
    table = _READERS[path.suffix.lower()](path)
    frames = len(table.values)
    if not 2 <= frames <= MOST_FRAMES:
        raise InputError(f"{path}: has {frames} frames; it must have 2 to {MOST_FRAMES}")
    if table.rate is not None and not SLOWEST <= table.rate <= FASTEST:
        raise InputError(
            f"{path}: its rate is {table.rate:.6g} frames a second; {SLOWEST:g} to {FASTEST:g} are valid"
        )
    table, notes = one_subject(table, path, subject)
    points = principal_points(table, path)
    points[~(np.abs(points) < FARTHEST).all(axis=2) | (points == 0.0).all(axis=2)] = np.nan
    if table.up is not None:
        return np.asarray(points @ np.array(UPRIGHT[table.up], dtype=np.float64).T), table.rate, notes
    known = int(np.isfinite(points).all(axis=(1, 2)).sum())
    if known < 2:
        raise InputError(f"{path}: a performer is in {known} of its frames; at least 2 are needed")
    return _upright(points * _unit_m(table, points, path)), table.rate, notes


def _unit_m(table: PointTable, points: Array, path: Path) -> float:
    at = {name: points[:, index] for index, name in enumerate(HUMAN.point_names)}
    ends = [
        (f"{one}.{side}", f"{other}.{side}")
        for side in "LR"
        for one, other in (("hip", "knee"), ("knee", "ankle"))
    ]
    with np.errstate(all="ignore"):
        lengths = [np.nanmedian(np.linalg.norm(at[one] - at[other], axis=1)) for one, other in ends]
    leg = 0.5 * float(np.sum(lengths))
    units = UNITS_M.values() if table.unit_m is None else (table.unit_m,)
    unit = min(units, key=lambda unit: abs(np.log(max(leg, 1e-12) * unit / 0.85)))
    if not SHORTEST_LEG_M <= leg * unit <= LONGEST_LEG_M:
        raise InputError(
            f"{path}: its legs are {leg * unit:.3g} m long; a person's are {SHORTEST_LEG_M} to "
            f"{LONGEST_LEG_M} m, so look at its unit and scale"
        )
    return unit


def _upright(points: Array) -> Array:
    """The points with Z up."""
    names = HUMAN.point_names
    feet = points[:, [names.index("ankle.L"), names.index("ankle.R")]].mean(axis=1)
    tall = points[:, names.index("head")] - feet
    mean = np.nanmean(tall, axis=0)
    axis = int(np.argmax(np.abs(mean)))
    return np.asarray(points @ np.array(UPRIGHT[axis, 1 if mean[axis] > 0.0 else -1], dtype=np.float64).T)


# --- csv with columns NAME_x, NAME_y, NAME_z or NAME_3DX ..., and npy without names


def _read_csv(path: Path) -> PointTable:
    try:
        text = re.sub(r"\Asep=.\s+", "", read_saved_text(path))  # which spreadsheets write
        separator = max(",;\t", key=text.partition("\n")[0].count)
        rows = csv.reader(io.StringIO(text, newline=""), delimiter=separator)
        header = [name.strip() for name in next(rows, [])]
        lines = [row for row in rows if row]
    except csv.Error as error:
        raise InputError(f"{path}: cannot be read as a csv ({error})") from error
    if separator == "," and lines and len(lines[0]) >= 2 * len(header) - 2 > len(header):
        raise InputError(
            f"{path}: has commas between its columns and, as it seems, in its numbers; they must have "
            "decimal points, or semicolons between the columns"
        )
    values = _numbers(lines, len(header), path, 2)
    columns: dict[str, dict[str, int]] = {}
    for index, name in enumerate(header):
        axis = _AXIS.search(name)
        if axis is not None and axis.start() > 0:
            columns.setdefault(name[: axis.start()], {})[axis[1].lower()] = index
    names = [name for name, axes in columns.items() if len(axes) == 3]
    if not names:
        raise InputError(
            f"{path}: has no points; a csv of points has columns like left_knee_x, left_knee_y, left_knee_z"
        )
    places = np.stack([values[:, [columns[name][axis] for axis in "xyz"]] for name in names], axis=1)
    if any(name.endswith("_3DX") for name in header):  # MHR-70: meters in a camera's axes, y down
        return PointTable(tuple(names), places, None, 1.0, MHR_UP)
    times = [header.index(name) for name in ("time", "timestamp", "time_s") if name in header]
    return PointTable(tuple(names), places, _rate_of(values[:, times[0]]) if times else None)


def _numbers(lines: Iterable[Sequence[str]], width: int, path: Path, first: int) -> Array:
    rows = []
    for number, line in enumerate(lines, first):
        if len(line) != width:
            raise InputError(
                f"{path}: line {number} has {len(line)} columns; it must have {width} as the header"
            )
        try:
            rows.append([float(with_decimal_point(cell)) if cell.strip() else np.nan for cell in line])
        except ValueError as error:
            raise InputError(f"{path}: line {number}: {error}; it must have numbers alone") from error
    return np.array(rows, dtype=np.float64).reshape(-1, width)


def _rate_of(times: Array) -> float | None:
    steps = np.diff(times)
    steps = steps[np.isfinite(steps) & (steps > 0.0)]
    return 1.0 / float(np.median(steps)) if len(steps) else None


def _read_npy(path: Path) -> PointTable:
    try:
        values = np.load(path, mmap_mode="r", allow_pickle=False)
        shape = values.shape
        if values.dtype.kind not in "fiu" or len(shape) != 3 or shape[2] != 3 or shape[1] < len(MEDIAPIPE):
            raise InputError(
                f"{path}: has the shape {shape}; it must be frames, at least {len(MEDIAPIPE)} points and "
                "x, y, z, as FreeMoCap writes them"
            )
        points = np.array(values[: MOST_FRAMES + 1, : len(MEDIAPIPE)], dtype=np.float64)
    except (OSError, ValueError, EOFError, TypeError, SyntaxError) as error:
        raise InputError(f"{path}: cannot be read as an npy of numbers ({error})") from error
    return PointTable(MEDIAPIPE, points)


# --- TRC: five lines of header, then number, time and the coordinates of each frame


def _read_trc(path: Path) -> PointTable:
    lines = read_saved_text(path).splitlines()
    if len(lines) < 6 or not lines[0].startswith("PathFileType"):
        raise InputError(f"{path}: is no TRC; it must begin with PathFileType")
    head = dict(zip(lines[1].split(), lines[2].split(), strict=False))
    names = [name.strip() for name in lines[3].split("\t")[2:] if name.strip()]
    width = 2 + 3 * len(names)
    if not 0 < len(names) <= MOST_POINTS:
        raise InputError(f"{path}: names {len(names)} points; 1 to {MOST_POINTS} are valid")
    rows = [line.rstrip("\r\n").split("\t") for line in lines[5:] if line.strip()]
    cells = [(row + [""] * width)[:width] if len(row) <= width + 1 else row for row in rows]
    values = _numbers(cells, width, path, 6)
    try:
        rate = float(with_decimal_point(head.get("DataRate", "nan")))
    except ValueError:
        rate = float("nan")
    by_time = _rate_of(values[:, 1])
    if by_time is not None and not abs(by_time - rate) <= 0.02 * by_time:
        raise InputError(
            f"{path}: DataRate is {shown(head.get('DataRate', ''))}, but its times follow at {by_time:.6g} "
            "a second; they must agree"
        )
    unit = UNITS_M.get(head.get("Units", "").lower())
    return PointTable(tuple(names), values[:, 2:].reshape(len(values), -1, 3), rate, unit)


def write_trc(
    path: Path, points: Array, rate: float, names: Sequence[str] = HUMAN.point_names, title: str = "motion"
) -> None:
    """Write points (F, N, 3) [m], Z up, as a TRC in millimeters with Y up, whole or not at all."""
    frames, count = points.shape[:2]
    millimeters = 1e3 * np.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1)
    axes = [f"{axis}{number}" for number in range(1, count + 1) for axis in "XYZ"]
    lines = [
        f"PathFileType\t4\t(X/Y/Z)\t{title}.trc",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
        f"{rate:.6g}\t{rate:.6g}\t{frames}\t{count}\tmm\t{rate:.6g}\t1\t{frames}",
        "Frame#\tTime\t" + "\t\t\t".join(_marker_name(name) for name in names) + "\t\t",
        "\t\t" + "\t".join(axes),
        "",
    ]
    for number, row in enumerate(millimeters.reshape(frames, -1)):
        cells = ["" if np.isnan(value) else f"{value:.3f}" for value in row]
        lines.append("\t".join([str(number + 1), f"{number / rate:.6f}", *cells]))
    write_atomically(path, lambda beside: beside.write_text("\n".join([*lines, ""]), encoding="utf-8"))


def _marker_name(name: str) -> str:
    """`elbow.L` is LElbow."""
    stem, _, side = name.partition(".")
    return side + stem.capitalize()


# --- C3D: markers of motion capture, in binary


def _read_c3d(path: Path) -> PointTable:
    import c3d

    frames: list[Array] = []
    try:
        with path.open("rb") as file, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            reader = c3d.Reader(file)
            names = tuple(str(label).strip() for label in reader.point_labels)
            rate = float(reader.point_rate)
            unit = reader.get("POINT:UNITS")
            units = "" if unit is None else str(unit.string_value).strip(" \0").lower()
            for _, points, _ in reader.read_frames(copy=True, camera_sum=False):
                frames.append(np.where(points[: len(names), 3:4] < 0.0, np.nan, points[: len(names), :3]))
                if len(frames) > MOST_FRAMES:
                    break
    except Exception as error:  # the library raises whatever a damaged file makes of it
        raise InputError(f"{path}: cannot be read as a C3D ({describe_unexpected(error)})") from error
    if not frames or len({len(points) for points in frames}) > 1:
        raise InputError(f"{path}: has no points; a C3D of markers must have the same ones in every frame")
    values = np.array(frames, dtype=np.float64)
    return PointTable(names[: values.shape[1]], values, rate, UNITS_M.get(units))


def write_c3d(path: Path, points: Array, rate: float, names: Sequence[str] = HUMAN.point_names) -> None:
    """Write points (F, N, 3) [m] as a C3D in millimeters with Z up, whole or not at all."""
    import c3d

    writer = c3d.Writer(point_rate=rate, analog_rate=0.0, point_units="mm  ")
    writer.set_point_labels([_marker_name(name) for name in names])
    writer.set_screen_axis("+X", "+Z")
    absent = np.isnan(points).any(axis=-1, keepdims=True)
    columns = [np.where(absent, 0.0, 1e3 * points), np.where(absent, -1.0, 0.0), np.zeros_like(absent, float)]
    rows = np.concatenate(columns, axis=-1).astype(np.float32)
    writer.add_frames([(row, np.zeros((0, 0), np.float32)) for row in rows])

    def write(beside: Path) -> None:
        with beside.open("wb") as file, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # it misses forces
            writer.write(file)

    write_atomically(path, write)


_READERS = {".csv": _read_csv, ".npy": _read_npy, ".trc": _read_trc, ".c3d": _read_c3d}
POINT_ENDINGS = tuple(_READERS)


LARGEST_BVH_BYTES = 2**29
_RATE = re.compile(r"Frame\s+Time:\s*(\S+)", re.IGNORECASE)
_FRAMES = re.compile(r"Frames:\s*(\S+)", re.IGNORECASE)


@dataclass
class _Root:
    """A ROOT of the hierarchy."""

    name: str
    first: int  # its first channel
    lines: list[str]
    joints: int = 0
    channels: int = 0


def read_bvh(path: Path, subject: str | None = None) -> tuple[str, tuple[str, ...]]:
    """The text of a BVH with one ROOT alone, and notes.

    Of several ROOTs it is that of the subject, or else the one with the most joints.

    Raises:
        InputError: It is no BVH, its header lies about its rate or frames, which Blender would believe,
            or it has no such subject.
    """
    if regular_file_size(path, "a BVH") > LARGEST_BVH_BYTES:
        raise InputError(f"{path}: is larger than {LARGEST_BVH_BYTES // 2**20} MB; a motion must be smaller")
    head, _, rest = read_saved_text(path).partition("MOTION")
    matches = [pattern.search(rest[:1000]) for pattern in (_FRAMES, _RATE)]
    if "HIERARCHY" not in head[:1000] or matches[0] is None or matches[1] is None:
        raise InputError(f"{path}: is no BVH; it must have HIERARCHY, MOTION, Frames and Frame Time")
    frames, step = matches[0][1], with_decimal_point(matches[1][1])
    seconds = _number(step)
    if not 1.0 / FASTEST <= seconds <= 1.0 / SLOWEST:
        raise InputError(
            f"{path}: Frame Time is {step[:20]}; {1.0 / FASTEST:g} to {1.0 / SLOWEST:g} s are valid"
        )
    rows = [
        [with_decimal_point(word) for word in line.split()]
        for line in rest[matches[1].end() :].splitlines()
        if line.strip()
    ]
    if _number(frames) != len(rows):
        raise InputError(f"{path}: Frames is {frames[:20]}, but it has {len(rows)} rows of numbers")
    comma = next((word for row in rows for word in row if "," in word), None)
    if comma is not None:
        raise InputError(
            f"{path}: has {shown(comma[:20])} among its numbers; they must have a decimal point, or one "
            "comma in its place, and spaces between them"
        )
    roots = _roots(head)
    notes: tuple[str, ...] = ()
    lines = [line for root in roots for line in root.lines]
    if len(roots) > 1 or (roots and subject not in (None, path.stem)):
        index, notes = chosen_subject(
            path, [root.name for root in roots], [root.joints for root in roots], subject
        )
        root = roots[index]
        lines, end = root.lines, root.first + root.channels
        if min(map(len, rows), default=0) < roots[-1].first + roots[-1].channels:
            raise InputError(f"{path}: has rows with fewer numbers than its ROOTs have channels")
        rows = [row[root.first : end] for row in rows]
    numbers = "\n".join(" ".join(row) for row in rows)
    hierarchy = "\n".join(lines)
    return f"HIERARCHY\n{hierarchy}\nMOTION\nFrames: {frames}\nFrame Time: {step}\n{numbers}\n", notes


def _roots(head: str) -> list[_Root]:
    """The ROOTs of a hierarchy, each with its lines."""
    roots: list[_Root] = []
    for line in head.splitlines():
        words = line.split()
        if not words or (not roots and words[0].upper() != "ROOT"):
            continue
        if words[0].upper() == "ROOT":
            first = roots[-1].first + roots[-1].channels if roots else 0
            roots.append(_Root(" ".join(words[1:]), first, []))
        root = roots[-1]
        root.joints += words[0].upper() in ("ROOT", "JOINT")
        if words[0].upper() == "OFFSET":
            line = " ".join(with_decimal_point(word) for word in words)
        elif words[0].upper() == "CHANNELS":
            root.channels += len(words) - 2
        root.lines.append(line)
    return roots


def _number(text: str) -> float:
    with suppress(ValueError):
        return float(text)
    return float("nan")
