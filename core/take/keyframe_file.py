"""`keyframes.json`: posed frames, given by thirteen points or by the values of the degrees of freedom."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np

from .. import MOST_FRAMES
from ..arrays import chunks
from ..body.human import HUMAN
from ..body.kinematics import Body
from ..body.posture import FARTHEST_M, Posture, PostureValues, rounded
from ..body.posture_fit import fit_posture
from ..errors import InputError
from ..files.json_file import read_json, write_json
from ..files.kinds import ByName, Choice, Items, Number
from ..files.records import Record
from ..prior.keyframes import Keyframe, Matched
from .evidence import Frame

FEWEST_KEYFRAMES = 2
"""Fewest that can be interpolated."""
MOST_KEYFRAMES = 20_000
"""Ten a hundred frames in two hours of film."""
FOUND = "found"
DEPTHS = (FOUND,)
SMALLEST_EXTENT_M = 0.05
"""Largest distance of a point from their mean, below which all points are one."""
PLACE = f"[x, y, z] in meters, each within {FARTHEST_M:g} m of the origin"
Place = Annotated[
    tuple[Annotated[float, Number(-FARTHEST_M, FARTHEST_M)], ...], Items("numbers", 3, 3, PLACE)
]


@dataclass(frozen=True, eq=False)
class KeyframeRow(Record):
    """A posed frame, or a frame whose posture was found in the footage."""

    frame: Frame
    """Scene frame within the clip; each frame once."""
    posture: Annotated[Posture, PostureValues(HUMAN)] | None = None
    """The posture by degree of freedom; takes precedence over points."""
    points: (
        Annotated[
            Mapping[str, Place],
            ByName("13 points", names=HUMAN.point_names, needs=HUMAN.point_names, strict=False),
        ]
        | None
    ) = None
    """The thirteen joint centers [m], world axes."""
    matched: Matched | None = None
    """Where the posture was found; null for a posed one."""
    depth: Annotated[str, Choice(DEPTHS)] | None = None
    """Of a posed one: found where a person put it right in the picture alone; null where in depth too."""

    def mistake(self) -> str:
        """See `Record`."""
        if self.depth is not None and self.matched is not None:
            return "has both matched and depth; depth is only of keyframes that a person put right"
        if self.points is None:
            return (
                "" if self.posture is not None else "has neither points nor posture; it must have one of them"
            )
        points = np.array(list(self.points.values()))
        extent_m = float(np.linalg.norm(points - points.mean(axis=0), axis=-1).max())
        if extent_m >= SMALLEST_EXTENT_M:
            return ""
        return "points all lie in one place; they must be the 13 joints of a person, in meters"


@dataclass(frozen=True, eq=False)
class KeyframeFile(Record):
    """The fields of `keyframes.json`."""

    TITLE = "keyframes"

    keyframes: Annotated[tuple[KeyframeRow, ...], Items("keyframes", 0, MOST_KEYFRAMES)]
    """Keyframes in any order; a take whose other keyframes are not found needs two."""


def read_keyframes(
    path: Path, body: Body, frame_start: int, frame_count: int | None, fewest: int = FEWEST_KEYFRAMES
) -> tuple[Keyframe, ...]:
    """Read keyframes, in the order of their frames.

    A keyframe holds `frame` and `posture` (every degree of freedom by name, meters and radians), or `frame`
    and `points` (thirteen points [m], world axes), to which a posture of the actor is fitted. With both, the
    posture counts. A matched keyframe names its library in `matched`.
    """
    rows = KeyframeFile.from_json(read_json(path), str(path)).keyframes
    if len(rows) < fewest:
        raise InputError(
            f"{path}: keyframes has {len(rows)} of them; at least {fewest} are needed, "
            "better 10 per 100 frames"
        )
    last = frame_start + (frame_count or MOST_FRAMES) - 1
    seen: set[int] = set()
    for index, frame in enumerate(row.frame for row in rows):
        if not frame_start <= frame <= last:
            clip = (
                f"the clip's frames are {frame_start} to {last}"
                if frame_count
                else f"the clip begins at {frame_start}"
            )
            raise InputError(
                f"{path}: keyframes[{index}]: frame is {frame}; it must lie in the clip, and {clip}"
            )
        if frame in seen:
            raise InputError(f"{path}: frame {frame} is given twice; each frame may be posed once")
        seen.add(frame)
    keyframes = _keyframes(rows, frame_start, body)
    return tuple(sorted(keyframes, key=lambda keyframe: keyframe.index))


def write_keyframes(path: Path, keyframes: Sequence[Keyframe], body: Body, frame_start: int) -> None:
    """Write keyframes with their posture, which `read_keyframes` reads back, and their thirteen points."""
    rows = []
    for keyframe in keyframes:
        points = rounded(body.points(body.pose(keyframe.posture)))
        named = dict(zip(body.skeleton.point_names, points, strict=True))
        depth = FOUND if keyframe.depth_found else None
        frame = keyframe.index + frame_start
        rows.append(KeyframeRow(frame, keyframe.posture, named, keyframe.matched, depth))
    write_json(path, KeyframeFile(tuple(rows)).to_json(), indent=1)


def _keyframes(rows: Sequence[KeyframeRow], frame_start: int, body: Body) -> list[Keyframe]:
    unseen = np.full((len(body.skeleton.point_names), 3), np.nan)
    points = np.array([unseen if row.points is None else list(row.points.values()) for row in rows])
    postures = {index: row.posture for index, row in enumerate(rows) if row.posture is not None}
    points_only = np.array([index for index in range(len(rows)) if index not in postures], dtype=np.intp)
    for chunk in chunks(points_only, 500) if len(points_only) else []:
        fitted = fit_posture(body, points[chunk]).posture
        postures.update({int(index): fitted[row] for row, index in enumerate(chunk)})
    keyframes = []
    for index, row in enumerate(rows):
        error = np.linalg.norm(body.points(body.pose(postures[index])) - points[index], axis=-1)
        residual_m = float(np.nan_to_num(error.mean()))
        at, found = row.frame - frame_start, row.depth is not None
        keyframes.append(Keyframe(at, postures[index], residual_m, row.matched, found))
    return keyframes
