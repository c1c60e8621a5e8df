"""Score of a motion against the truth, in the measures of the field.

MPJPE, the mean per joint position error: Ionescu et al. (2014), *Human3.6M*, eq. 8. The split along and
across the line of sight matters with a single camera: across it the image helps, along it not.
"""

from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

import numpy as np

from ..arrays import Array
from ..body.human import ANKLES, HIPS, HUMAN
from ..body.posture import FARTHEST_M
from ..camera.camera import Camera
from ..errors import InputError, shown
from ..files.json_file import read_json
from ..files.kinds import ByName, Items, NumberArray, Whole
from ..files.records import Record


@dataclass(frozen=True)
class Score:
    """Errors of a motion in millimeters; those over free frames leave the keyframes out."""

    frames: int
    keyframes: int
    mpjpe: float  # mean over free frames and 13 points of the distance to the true point
    mpjpe_all: float  # the same over all frames
    rooted: float  # like `mpjpe`, after both are moved so that the hips' midpoints coincide
    depth: float  # mean absolute error along the line from the camera to the true point, free frames
    image: float  # mean error across that line, free frames
    worst_p95: float  # 95th percentile of the points' errors, free frames
    jitter: float  # mean length of the error's second difference, per frame²
    skate: float | None  # mean horizontal travel a frame of ankles that truly stand
    coverage95: float | None  # share of points within 1.96 sigma; 0.90 to 0.99 where it is honest

    def to_dict(self) -> dict[str, float | None]:
        """The measures by name."""
        return asdict(self)


def score_points(
    points: Array,
    truth: Array,
    keyframe_indices: Collection[int],
    camera: Camera,
    sigma_m: Array | None = None,
) -> Score:
    """Score points (F, 13, 3) against true ones [m]; frames of NaN, in which nobody is there, do not count.

    Keyframes count from 0; the camera's lines of sight split the error; `sigma_m` (F, 13) are roots of the
    traces of the points' covariances.

    Raises:
        InputError: The frames differ, or every frame is a keyframe.
    """
    if points.shape != truth.shape:
        raise InputError(f"the motion has {len(points)} frames; the truth has {len(truth)}")
    free = np.ones(len(truth), dtype=bool)
    free[list(keyframe_indices)] = False
    if not free.any():
        raise InputError("every frame is a keyframe; a score needs at least one frame without a keyframe")
    known = np.isfinite(points).all(axis=(1, 2))
    free &= known
    if not free.any():
        raise InputError("the motion is empty in every frame without a keyframe; a score needs at least one")
    error = points - truth  # (F, P, 3)
    distance = np.linalg.norm(error, axis=-1)  # (F, P)
    sight = camera.sight(truth, np.arange(len(truth))[:, None])
    along = np.sum(error * sight, axis=-1)
    across = np.linalg.norm(error - along[..., None] * sight, axis=-1)
    rooted = np.linalg.norm(error - error[:, HIPS].mean(axis=1, keepdims=True), axis=-1)
    bend = np.linalg.norm(np.diff(error, n=2, axis=0), axis=-1)
    bend = bend[np.isfinite(bend).all(axis=1)]
    # An ankle whose true position moves less than this in a frame stands.
    stands = np.linalg.norm(np.diff(truth[:, ANKLES], axis=0), axis=-1) < 0.004
    travel = np.linalg.norm(np.diff(points[:, ANKLES, :2], axis=0), axis=-1)
    stands &= np.isfinite(travel)
    # Half-width of a normal distribution's 95 % interval, in standard deviations.
    covered = None if sigma_m is None else float(np.mean((distance <= 1.96 * sigma_m)[known]))
    return Score(
        frames=len(truth),
        keyframes=len(set(keyframe_indices)),
        mpjpe=1e3 * float(distance[free].mean()),
        mpjpe_all=1e3 * float(distance[known].mean()),
        rooted=1e3 * float(rooted[free].mean()),
        depth=1e3 * float(np.abs(along)[free].mean()),
        image=1e3 * float(across[free].mean()),
        worst_p95=1e3 * float(np.percentile(distance[free], 95)),
        jitter=1e3 * float(bend.mean()) if len(bend) else 0.0,
        skate=1e3 * float(travel[stands].mean()) if stands.any() else None,
        coverage95=covered,
    )


@dataclass(frozen=True, eq=False)
class TruthFile(Record):
    """The fields of `truth.json`."""

    TITLE = "truth"

    frames: Annotated[tuple[Annotated[int, Whole(-(10**8), 10**8)], ...], Items("frames", 1, 10**6)]
    """Every scene frame of the clip, in order."""
    points: Annotated[
        Mapping[str, Array],
        ByName(
            "13 points",
            names=HUMAN.point_names,
            needs=HUMAN.point_names,
            strict=False,
            item=NumberArray((-1, 3), FARTHEST_M),
        ),
    ]
    """Positions by point: one [x, y, z] a frame [m], world axes."""


def read_truth(path: Path, frame_start: int, frame_count: int) -> Array:
    """(F, 13, 3) true points [m] of a `truth.json`.

    Raises:
        InputError: It is unusable or lacks a frame.
    """
    truth = TruthFile.from_json(read_json(path), str(path))
    wanted = tuple(range(frame_start, frame_start + frame_count))
    if truth.frames != wanted:
        raise InputError(
            f"{path}: frames is {shown(list(truth.frames))}; it must list {wanted[0]} to "
            f"{wanted[-1]} in order"
        )
    if any(len(places) != frame_count for places in truth.points.values()):
        raise InputError(f"{path}: points: each point needs {frame_count} [x, y, z] in m")
    return np.stack(list(truth.points.values()), axis=1)
