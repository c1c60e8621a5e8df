"""A motion: posture, thirteen points and their covariance for every frame of the clip."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any

import numpy as np

from .. import MOST_FRAMES
from ..arrays import Array, BoolArray, IndexArray
from ..body.actor import Actor
from ..body.fingers import Hands
from ..body.human import HUMAN, LIMBS
from ..body.kinematics import Body
from ..body.posture import Posture, posture_to_json, rounded
from ..body.skeleton import FINGERS, SIDES
from ..errors import ConversionError, shown
from ..files.json_file import read_json, write_json
from ..files.kinds import ByName, Choice, Items, Kind, NumberArray, Whole, number_array, refuse
from ..files.records import Record
from .evidence import Frame, FrameCount, FrameRate, Line


@dataclass(frozen=True, eq=False)
class Motion:
    """A reconstructed motion of F frames.

    In those in which the performer is not there, points and covariance are NaN, and the posture is that of
    the nearest frame in which he is.
    """

    body: Body
    fps: float
    frame_start: int
    time_s: Array
    """(F,) time stamp of each frame from the first [s]; uneven for variable frame rate."""
    posture: Posture
    points: Array
    """(F, 13, 3) principal points in the world [m]."""
    point_covariance: Array
    """(F, 13, 3, 3) estimated covariance of each point [m²]."""
    keyframe_indices: tuple[int, ...]
    method: str
    diagnostics: Mapping[str, Array] = field(default_factory=lambda: MappingProxyType({}))
    """Diagnostics of the estimate by name, (F, ...) each."""
    empty: tuple[int, ...] = ()
    """Indices of the frames in which the performer is not there."""
    unseen: tuple[str, ...] = ()
    """Limbs that are never seen and rest, as in `LIMBS`."""
    hands: Hands | None = None
    """How hands are bent and closed, as they are seen; None where none was looked at."""

    @property
    def scene_frames(self) -> Array:
        """(F,) Blender scene frame of each clip frame; fractional for variable frame rate."""
        return np.asarray(self.frame_start + self.time_s * self.fps)

    @property
    def sigma_m(self) -> Array:
        """(F, 13) square root of the trace of each point's covariance [m]."""
        return np.sqrt(np.trace(self.point_covariance, axis1=-2, axis2=-1))

    @property
    def there(self) -> BoolArray:
        """(F,) whether the performer is there."""
        there = np.ones(len(self.time_s), dtype=np.bool_)
        there[list(self.empty)] = False
        return there

    def emptied(self, there: BoolArray) -> "Motion":
        """The motion with nothing in frames in which the performer is not there, of F."""
        if there.all():
            return self
        return replace(
            self,
            posture=self.posture[_nearest(there)],
            hands=None if self.hands is None else self.hands[_nearest(there)],
            points=np.where(there[:, None, None], self.points, np.nan),
            point_covariance=np.where(there[:, None, None, None], self.point_covariance, np.nan),
            empty=tuple(np.flatnonzero(~there).tolist()),
        )

    def without_absence(self) -> "Motion":
        """The motion of the frames in which the performer is there alone, without diagnostics."""
        there = self.there
        if there.all():
            return self
        index = np.cumsum(there) - 1
        return replace(
            self,
            time_s=self.time_s[there],
            posture=self.posture[there],
            hands=None if self.hands is None else self.hands[there],
            points=self.points[there],
            point_covariance=self.point_covariance[there],
            keyframe_indices=tuple(int(index[key]) for key in self.keyframe_indices if there[key]),
            diagnostics=MappingProxyType({}),
            empty=(),
        )


def _nearest(there: BoolArray) -> IndexArray:
    """(F,) for each frame the nearest in which the performer is there: itself where he is."""
    known = np.flatnonzero(there)
    frame = np.arange(len(there))
    after = np.minimum(np.searchsorted(known, frame), len(known) - 1)
    before = np.maximum(after - 1, 0)
    nearer = np.abs(known[before] - frame) < np.abs(known[after] - frame)
    return known[np.where(nearer, before, after)]


LARGEST_BYTES = 2**29
"""Two hours of motion: about 2 kB a frame."""
LARGEST_NUMBER = 1e15
"""Of coordinates, angles, times and covariances, in the file's units."""
SIGNIFICANT_DIGITS = 6
UPPER = (np.array([0, 0, 0, 1, 1, 2]), np.array([0, 1, 2, 1, 2, 2]))
"""Rows and columns of xx, xy, xz, yy, yz, zz: the upper triangle of a covariance matrix."""


FINGER_NAMES = tuple(f"{finger}.{side}" for side in SIDES for finger in FINGERS)
LISTS = ("points", "posture", "sigma_m", "covariance_mm2", "curls_rad", "wrists_rad", "hands_seen")
"""Fields with lists over the frames by name."""


class Diagnostic(Kind):
    """A number or null, or nested lists of them; an array with NaN for null."""

    valid = "numbers or null, or lists of them"

    def read(self, value: Any, where: str, name: str) -> Array:
        """See `Kind`."""
        array = number_array(value, nulls=True)
        if array is None:
            refuse(where, name, value, self.valid)
        return array


def _lists(names: tuple[str, ...], *shape: int) -> ByName:
    item = NumberArray((-1, *shape), LARGEST_NUMBER, null_rows=True)
    return ByName("lists by name", names=names, needs=names, strict=False, item=item)


@dataclass(frozen=True, eq=False)
class MotionFile(Record):
    """The fields of `motion.json`; lists run over the F frames of the clip."""

    VERSION, TITLE = 1, "motion"

    fps: FrameRate
    """Frames per second."""
    frame_start: Frame
    """Scene frame of the first frame."""
    frame_count: FrameCount
    """Number of frames, F."""
    method: Line
    """map, ekf, interpolation, or mend for a motion from elsewhere."""
    keyframes: Annotated[tuple[Annotated[int, Whole(-(10**8), 10**8)], ...], Items("frames", 0, MOST_FRAMES)]
    """Scene frames of the keyframes."""
    time_s: Annotated[Array, NumberArray((-1,), LARGEST_NUMBER)]
    """Time of each frame [s]."""
    points: Annotated[Mapping[str, Array], _lists(HUMAN.point_names, 3)]
    """The thirteen joint centers: F times [x, y, z] [m] each; here and below null in frames in which the
    performer is not there."""
    posture: Annotated[Mapping[str, Array], _lists(HUMAN.dof_names)]
    """The posture by degree of freedom: F numbers [m, rad] each."""
    actor: Actor
    """The performer's size."""
    diagnostics: Annotated[Mapping[str, Array], ByName("lists by name", 100, item=Diagnostic())]
    """Diagnostics of the estimate by name; null where a number does not apply."""
    sigma_m: Annotated[Mapping[str, Array], _lists(HUMAN.point_names)] = field(default_factory=dict)
    """Square root of the trace of each point's covariance: F numbers [m] each; only for methods with
    uncertainty."""
    covariance_mm2: Annotated[Mapping[str, Array], _lists(HUMAN.point_names, 6)] = field(default_factory=dict)
    """Covariance of each point: F times xx, xy, xz, yy, yz, zz [mm²]."""
    unseen: Annotated[
        tuple[Annotated[str, Choice(LIMBS)], ...], Items("limbs", 0, len(LIMBS), unique="limb")
    ] = ()
    """Limbs that are never seen: they rest, and characters keep their own."""
    curls_rad: Annotated[Mapping[str, Array], _lists(FINGER_NAMES)] = field(default_factory=dict)
    """Mean flexion of each finger's joints, toward the palm: F numbers [rad] each; only where hands were
    looked at, as the two below."""
    wrists_rad: Annotated[Mapping[str, Array], _lists(SIDES, 3)] = field(default_factory=dict)
    """Turn of each hand in its forearm's frame as a rotation vector: F times [x, y, z] [rad] each."""
    hands_seen: Annotated[Mapping[str, Array], _lists(SIDES)] = field(default_factory=dict)
    """How far each hand is to be believed, 0 to 1: F numbers each."""

    ORDER = (
        *("fps", "frame_start", "frame_count", "method", "keyframes", "time_s", "points", "sigma_m"),
        *("covariance_mm2", "posture", "actor", "diagnostics", "unseen"),
        *("curls_rad", "wrists_rad", "hands_seen"),
    )

    def mistake(self) -> str:
        """See `Record`."""
        rows = {"time_s": self.time_s}
        if len({bool(own) for own in (self.curls_rad, self.wrists_rad, self.hands_seen)}) > 1:
            return "curls_rad, wrists_rad and hands_seen are together or left out"
        for name in LISTS:
            rows |= {f"{name}.{key}": array for key, array in getattr(self, name).items()}
        for name, array in rows.items():
            if len(array) != self.frame_count:
                return (
                    f"{name} is a list of {len(array)}; it must have one entry for each of {self.frame_count}"
                )
        empty = np.isnan(self.points["head"]).any(axis=-1)
        if empty.all():
            return "points is null in every frame; a motion has a place in one frame or more"
        for name in LISTS:
            for key, array in getattr(self, name).items():
                if (np.isnan(array).reshape(len(array), -1).any(axis=1) != empty).any():
                    return f"{name}.{key} is null in other frames than points.head; null is for all or none"
        first, last = self.frame_start, self.frame_start + self.frame_count - 1
        if not all(first <= frame <= last for frame in self.keyframes):
            return (
                f"keyframes is {shown(list(self.keyframes))}; it must be a list of frames, {first} to {last}"
            )
        return ""


def write_motion(motion: Motion, path: Path) -> None:
    """Write a motion as `motion.json`, atomically; the same motion gives the same bytes.

    Lengths are in meters and angles in radians, rounded to 1e-6; lists run over the frames of the clip, and
    have null where the performer is not there.
    A method that has no covariance (all NaN) leaves `sigma_m` and `covariance_mm2` out.
    """
    frames, names = len(motion.time_s), motion.body.skeleton.point_names
    has_covariance, own = not np.isnan(motion.point_covariance).all(), motion.hands
    arrays = {"points": motion.points, "posture": motion.posture.to_vector()}
    arrays |= {"covariance": motion.point_covariance} if has_covariance else {}
    for name, values in arrays.items():
        bad = ~np.isfinite(values.reshape(frames, -1)).all(axis=1) & motion.there
        if bad.any():
            frame = int(np.flatnonzero(bad)[0]) + motion.frame_start
            raise ConversionError(
                f"the {motion.method} estimate has no finite {name} at frame {frame} and "
                f"{int(bad.sum()) - 1} more frames; nothing was written"
            )
    posture: dict[str, Any] = posture_to_json(motion.posture)
    lists: dict[str, tuple[Sequence[str], list[list[Any]]]] = {
        "points": (names, rounded(np.swapaxes(motion.points, 0, 1))),
        "posture": (tuple(posture), list(posture.values())),
    }
    if has_covariance:
        covariance = 1e6 * motion.point_covariance[:, :, UPPER[0], UPPER[1]]  # (F, P, 6), square millimeters
        lists["sigma_m"] = (names, rounded(motion.sigma_m.T))
        lists["covariance_mm2"] = (names, _significant(np.swapaxes(covariance, 0, 1)))
    if own is not None:
        lists["curls_rad"] = (FINGER_NAMES, rounded(own.curls.reshape(frames, -1).T))
        lists["wrists_rad"] = (SIDES, rounded(np.swapaxes(own.bend, 0, 1)))
        lists["hands_seen"] = (SIDES, rounded(own.sure.T))
    for _, columns in lists.values():
        for column in columns:
            for frame in motion.empty:
                column[frame] = None
    fields: dict[str, Any] = {
        name: dict(zip(keys, rows, strict=True)) for name, (keys, rows) in lists.items()
    }
    file = MotionFile(
        fps=motion.fps,
        frame_start=motion.frame_start,
        frame_count=frames,
        method=motion.method,
        keyframes=tuple(index + motion.frame_start for index in motion.keyframe_indices),
        time_s=rounded(motion.time_s),
        actor=motion.body.actor,
        diagnostics={name: _significant(rows) for name, rows in sorted(motion.diagnostics.items())},
        unseen=motion.unseen,
        **fields,
    )
    write_json(path, file.to_json())


def read_motion(path: Path) -> Motion:
    """Read a motion that `write_motion` wrote."""
    file = MotionFile.from_json(read_json(path, LARGEST_BYTES), str(path))
    body, points = Body(file.actor), np.stack(list(file.points.values()), axis=1)
    posture, there = np.stack(list(file.posture.values()), axis=1), np.isfinite(points).all(axis=(1, 2))
    covariance = np.full((*points.shape, 3), np.nan)
    if file.covariance_mm2:
        upper = 1e-6 * np.stack(list(file.covariance_mm2.values()), axis=1)
        covariance[:, :, UPPER[0], UPPER[1]] = covariance[:, :, UPPER[1], UPPER[0]] = upper
    hands = None
    if file.curls_rad:
        lists = (file.curls_rad, file.wrists_rad, file.hands_seen)
        curls, bend, sure = (np.stack(list(one.values()), axis=1) for one in lists)
        hands = Hands(curls.reshape(len(sure), len(SIDES), -1), bend, sure)[_nearest(there)]
    return Motion(
        body=body,
        fps=file.fps,
        frame_start=file.frame_start,
        time_s=file.time_s,
        posture=Posture.from_vector(body.skeleton, posture[_nearest(there)]),
        points=points,
        point_covariance=covariance,
        keyframe_indices=tuple(frame - file.frame_start for frame in file.keyframes),
        method=file.method,
        diagnostics=MappingProxyType(dict(file.diagnostics)),
        empty=tuple(np.flatnonzero(~there).tolist()),
        unseen=file.unseen,
        hands=hands,
    )


def _significant(values: Array) -> Any:
    """Nested lists of numbers rounded to six significant digits; null where a number is not finite."""
    array = np.asarray(values, dtype=np.float64)
    flat = [float(f"{x:.{SIGNIFICANT_DIGITS}g}") + 0.0 if np.isfinite(x) else None for x in array.ravel()]
    return np.array(flat, dtype=object).reshape(array.shape).tolist()
