"""`keyframes.json`: posed frames, given by thirteen points or by the values of the degrees of freedom."""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from ..arrays import Array, chunks
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.posture_fields import FARTHEST_M, PostureValues, posture_to_json, rounded
from ..body.posture_fit import fit_posture
from ..errors import InputError
from ..files.fields import Fields
from ..files.json_file import read_json, shown, write_json
from ..prior.keyframes import Keyframe, Matched

LONGEST_NAME = 200
FEWEST_KEYFRAMES = 2
"""Fewest that can be interpolated."""
MOST_KEYFRAMES = 20_000
"""Ten a hundred frames in two hours of film."""
SMALLEST_EXTENT_M = 0.05
"""Largest distance of a point from their mean, below which all points are one."""
FITTED_TOGETHER = 500
"""Keyframes whose points are fitted at once; bounds the memory."""


def read_keyframes(
    path: Path, body: Body, frame_start: int, frame_count: int | None, fewest: int = FEWEST_KEYFRAMES
) -> tuple[Keyframe, ...]:
    """Read keyframes, in the order of their frames.

    A keyframe holds `frame` and `posture` (every degree of freedom by name, meters and radians), or `frame`
    and `points` (thirteen points [m], world axes), to which a posture of the actor is fitted. With both, the
    posture counts. A matched keyframe names its library in `matched`.

    Args:
        path: The file.
        body: The actor's body.
        frame_start: Scene frame of the clip's first frame.
        frame_count: Frames of the clip; None where it is not known yet.
        fewest: Number of keyframes that are required.

    Raises:
        InputError: The file or a field is unusable, a frame is outside the clip or given twice, or there
            are too few keyframes, or too many.
    """
    fields = Fields(read_json(path), str(path))
    rows = fields.required("keyframes", "a list of keyframes")
    if not isinstance(rows, list):
        raise InputError(f"{path}: keyframes is {shown(rows)}; it must be a list of keyframes")
    if len(rows) < fewest:
        raise InputError(
            f"{path}: keyframes has {len(rows)} of them; at least {fewest} are needed, "
            "better 10 per 100 frames"
        )
    if len(rows) > MOST_KEYFRAMES:
        raise InputError(f"{path}: keyframes has {len(rows)} of them; at most {MOST_KEYFRAMES} are read")
    objects = [Fields.of(row, f"{path}: keyframes[{index}]") for index, row in enumerate(rows)]
    frames = [_frame_index(row, frame_start, frame_count) for row in objects]
    _refuse_duplicates(path, frames, frame_start)
    keyframes = _keyframes(objects, frames, body)
    return tuple(sorted(keyframes, key=lambda keyframe: keyframe.index))


def write_keyframes(path: Path, keyframes: Sequence[Keyframe], body: Body, frame_start: int) -> None:
    """Write keyframes with both their posture, which `read_keyframes` reads back, and their thirteen points.

    Raises:
        ConversionError: The file cannot be written.
    """
    rows = []
    for keyframe in keyframes:
        points = body.points(body.pose(keyframe.posture))
        row = {
            "frame": keyframe.index + frame_start,
            "posture": posture_to_json(keyframe.posture),
            "points": dict(zip(body.skeleton.point_names, rounded(points), strict=True)),
        }
        if keyframe.matched is not None:
            row["matched"] = asdict(keyframe.matched)
        rows.append(row)
    write_json(path, {"keyframes": rows}, indent=1)


def _frame_index(row: Fields, frame_start: int, frame_count: int | None) -> int:
    last = frame_start + (frame_count or 10**6) - 1
    frame = row.integer("frame", -(10**7), 10**7)
    if not frame_start <= frame <= last:
        clip = (
            f"the clip's frames are {frame_start} to {last}"
            if frame_count
            else f"the clip begins at {frame_start}"
        )
        raise InputError(f"{row.where}: frame is {frame}; it must lie in the clip, and {clip}")
    return frame - frame_start


def _refuse_duplicates(path: Path, indices: Sequence[int], frame_start: int) -> None:
    seen: set[int] = set()
    for index in indices:
        if index in seen:
            raise InputError(
                f"{path}: frame {index + frame_start} is given twice; each frame may be posed once"
            )
        seen.add(index)


def _keyframes(rows: Sequence[Fields], frames: Sequence[int], body: Body) -> list[Keyframe]:
    points = np.full((len(rows), len(body.skeleton.point_names), 3), np.nan)
    postures: dict[int, Posture] = {}
    for index, row in enumerate(rows):
        if row.has("posture"):
            postures[index] = PostureValues(body.skeleton).read(row.values["posture"], row.where, "posture")
        elif not row.has("points"):
            raise InputError(f"{row.where} has neither points nor posture; it must have one of them")
        if row.has("points"):
            points[index] = _points(
                row.child("points", "an object with 13 points"), body.skeleton.point_names
            )
    points_only = np.array([index for index in range(len(rows)) if index not in postures], dtype=np.intp)
    for chunk in chunks(points_only, FITTED_TOGETHER) if len(points_only) else []:
        fitted = fit_posture(body, points[chunk]).posture
        postures.update({int(index): fitted[row] for row, index in enumerate(chunk)})
    keyframes = []
    for index, frame in enumerate(frames):
        error = np.linalg.norm(body.points(body.pose(postures[index])) - points[index], axis=-1)
        residual_m = float(np.nan_to_num(error.mean()))
        keyframes.append(Keyframe(frame, postures[index], residual_m, _matched(rows[index])))
    return keyframes


def _matched(row: Fields) -> Matched | None:
    if not row.has("matched"):
        return None
    fields = row.child("matched", "an object with library, posture, mirrored and confidence")
    mirrored = fields.required("mirrored", "true or false")
    if not isinstance(mirrored, bool):
        raise InputError(f"{fields.where}: mirrored is {shown(mirrored)}; it must be true or false")
    names = []
    for name in ("library", "posture"):
        valid = f"a name of at most {LONGEST_NAME} characters"
        text = fields.text(name, valid)
        if len(text) > LONGEST_NAME:
            raise InputError(f"{fields.where}: {name} is {shown(text)}; it must be {valid}")
        names.append(text)
    return Matched(names[0], names[1], mirrored, fields.number("confidence", 0.0, 1.0))


def _points(fields: Fields, names: Sequence[str]) -> Array:
    valid = f"[x, y, z] in meters, each within {FARTHEST_M:g} m of the origin"
    rows = [fields.numbers(name, 3, -FARTHEST_M, FARTHEST_M, valid) for name in names]
    points = np.asarray(rows)
    extent_m = float(np.linalg.norm(points - points.mean(axis=0), axis=-1).max())
    if extent_m < SMALLEST_EXTENT_M:
        raise InputError(
            f"{fields.where} all lie in one place; they must be the 13 joints of a person, in meters"
        )
    return points
