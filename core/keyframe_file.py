"""`keyframes.json`: posed frames, given by thirteen points or by the values of the degrees of freedom."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .body.kinematics import Body
from .body.posture import Posture
from .body.posture_fit import fit_posture
from .errors import InputError
from .files.fields import Fields, listed
from .files.json_file import read_json, shown, write_json
from .prior.keyframes import Keyframe

Array = NDArray[np.float64]

FARTHEST_M = 1000.0
LARGEST_ANGLE_RAD = 4.0 * np.pi
DECIMALS = 6
"""Micrometres and microradians: far below any measurement, and files stay short."""


def read_keyframes(path: Path, body: Body, frame_start: int, frame_count: int | None) -> tuple[Keyframe, ...]:
    """Read keyframes, in the order of their frames.

    A keyframe holds `frame` and `posture` (every degree of freedom by name, metres and radians), or `frame`
    and `points` (thirteen points [m], world axes), to which a posture of the actor is fitted. With both, the
    posture counts.

    Args:
        path: The file.
        body: The actor's body.
        frame_start: Scene frame of the clip's first frame.
        frame_count: Frames of the clip; None where it is not known yet.

    Raises:
        InputError: The file or a field is unusable, a frame is outside the clip or given twice, or there
            are fewer than two keyframes.
    """
    fields = Fields(read_json(path), str(path))
    rows = fields.required("keyframes", "a list of keyframes")
    if not isinstance(rows, list):
        raise InputError(f"{path}: keyframes is {shown(rows)}; it must be a list of keyframes")
    if len(rows) < 2:
        raise InputError(
            f"{path}: keyframes has {len(rows)} of them; at least 2 are needed, better 10 per 100 frames"
        )
    posed = [Fields.of(row, f"{path}: keyframes[{place}]") for place, row in enumerate(rows)]
    indices = [_index(row, frame_start, frame_count) for row in posed]
    _refuse_twice(path, indices, frame_start)
    keyframes = _keyframes(posed, indices, body)
    return tuple(sorted(keyframes, key=lambda keyframe: keyframe.index))


def write_keyframes(path: Path, keyframes: Sequence[Keyframe], body: Body, frame_start: int) -> None:
    """Write keyframes with both their posture, which `read_keyframes` reads back, and their thirteen points.

    Raises:
        ConversionError: The file cannot be written.
    """
    rows = []
    for keyframe in keyframes:
        points = body.points(body.pose(keyframe.posture))
        rows.append(
            {
                "frame": keyframe.index + frame_start,
                "posture": posture_to_json(keyframe.posture),
                "points": dict(zip(body.skeleton.point_names, rounded(points), strict=True)),
            }
        )
    write_json(path, {"keyframes": rows}, indent=1)


def posture_to_json(posture: Posture) -> dict[str, Any]:
    """A posture, or a batch along the first axis, by name of degree of freedom [m, rad]."""
    vector = posture.to_vector()  # (..., D)
    return dict(zip(posture.skeleton.dof_names, rounded(np.moveaxis(vector, -1, 0)), strict=True))


def rounded(values: Array) -> Any:
    """Nested lists of numbers, rounded to six decimals, with no negative zero."""
    return (np.round(values, DECIMALS) + 0.0).tolist()


def _index(row: Fields, frame_start: int, frame_count: int | None) -> int:
    last = frame_start + (frame_count or 10**6) - 1
    frame = row.whole("frame", -(10**7), 10**7)
    if not frame_start <= frame <= last:
        clip = (
            f"the clip's frames are {frame_start} to {last}"
            if frame_count
            else f"the clip begins at {frame_start}"
        )
        raise InputError(f"{row.where}: frame is {frame}; it must lie in the clip, and {clip}")
    return frame - frame_start


def _refuse_twice(path: Path, indices: Sequence[int], frame_start: int) -> None:
    seen: set[int] = set()
    for index in indices:
        if index in seen:
            raise InputError(
                f"{path}: frame {index + frame_start} is given twice; each frame may be posed once"
            )
        seen.add(index)


def _keyframes(posed: Sequence[Fields], indices: Sequence[int], body: Body) -> list[Keyframe]:
    points = np.full((len(posed), len(body.skeleton.point_names), 3), np.nan)
    postures: dict[int, Posture] = {}
    for place, row in enumerate(posed):
        if row.has("posture"):
            valid = f"an object with {listed(body.skeleton.dof_names, 3)}"
            postures[place] = _posture(row.child("posture", valid), body)
        elif not row.has("points"):
            raise InputError(f"{row.where} has neither points nor posture; it must have one of them")
        if row.has("points"):
            points[place] = _points(
                row.child("points", "an object with 13 points"), body.skeleton.point_names
            )
    unposed = [place for place in range(len(posed)) if place not in postures]
    if unposed:
        fitted = fit_posture(body, points[unposed]).posture
        postures.update({place: fitted[row] for row, place in enumerate(unposed)})
    keyframes = []
    for place, index in enumerate(indices):
        error = np.linalg.norm(body.points(body.pose(postures[place])) - points[place], axis=-1)
        keyframes.append(Keyframe(index, postures[place], float(np.nan_to_num(error.mean()))))
    return keyframes


def _points(fields: Fields, names: Sequence[str]) -> Array:
    valid = f"[x, y, z] in metres, each within {FARTHEST_M:g} m of the origin"
    rows = [fields.numbers(name, 3, -FARTHEST_M, FARTHEST_M, valid) for name in names]
    places = np.asarray(rows)
    across = float(np.linalg.norm(places - places.mean(axis=0), axis=-1).max())
    if across < 0.05:
        raise InputError(
            f"{fields.where} all lie in one place; they must be the 13 joints of a person, in metres"
        )
    return places


def _posture(fields: Fields, body: Body) -> Posture:
    skeleton = body.skeleton
    unknown = [name for name in fields.values if name not in skeleton.dof_names]
    if unknown:
        names = listed(skeleton.dof_names)
        raise InputError(
            f"{fields.where} names the unknown degree of freedom {shown(unknown[0])}; known are {names}"
        )
    vector = [fields.number(name, -limit, limit) for name, limit in _dof_bounds(body).items()]
    return Posture.from_vector(skeleton, np.asarray(vector))


def _dof_bounds(body: Body) -> Mapping[str, float]:
    """Largest size of each degree of freedom: metres for places, radians for angles."""
    return {
        name: FARTHEST_M if ".location_" in name else LARGEST_ANGLE_RAD for name in body.skeleton.dof_names
    }
