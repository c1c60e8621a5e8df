"""Key reduction: few keys whose curves keep all joints and ends of a body within a tolerance."""

import heapq
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from itertools import count

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body import rotations
from .hermite import Spline, fit_keys, refit
from .rig import Rig, RigPose

REACH = 3  # number of keys on either side of a new or removed one that are fitted anew


@dataclass(frozen=True, eq=False)
class Trial:
    """The curves and their pose without one of the keys."""

    group: int
    spline: Spline
    frames: slice  # the frames that change
    pose: RigPose
    worst: float  # largest error of any point in those frames, in units of its tolerance


class KeyedBody:
    """Curves through keys for groups of bones; the bones of a group share their keys' frames."""

    def __init__(
        self,
        rig: Rig,
        times: Array,
        values: Sequence[Array],
        tolerance_m: Array,
        exact: IndexArray,
        groups: Sequence[tuple[int, ...]],
    ) -> None:
        """Keys at the first, the last and the exact frames only.

        Args:
            rig: The bones.
            times: (F,) rising times of the frames.
            values: For each bone its channels, (F, C): the target.
            tolerance_m: (F, P) largest allowed error of each of the rig's points in each frame [m].
            exact: Indices of frames that stay keys, with their own values.
            groups: Indices of bones, each bone in one group.
        """
        self.rig, self.times, self.posed, self.groups = rig, times, exact, groups
        self.pinned = [exact for _ in groups]
        """For each group the frames at which its keys have the target's own values."""
        self.tolerance_m = tolerance_m
        self.data = [np.concatenate([values[bone] for bone in group], axis=1) for group in groups]
        self._ends = [np.cumsum([values[bone].shape[1] for bone in group]) for group in groups]
        self.target = rig.pose(list(values))
        keys = np.union1d([0, len(times) - 1], exact).astype(np.intp)
        self.splines = [fit_keys(times, data, keys, exact) for data in self.data]
        self.update()

    def update(self) -> None:
        """Evaluate all curves and the pose they give."""
        last = len(self.times) - 1
        self.pose = self.rig.pose([one.evaluate(self.times, 0, last) for one in self.bone_splines()])

    def error_m(self) -> Array:
        """(F, P) distance of each point from its target [m]."""
        return np.asarray(np.linalg.norm(self.pose.points - self.target.points, axis=-1))

    def bone_splines(self) -> tuple[Spline, ...]:
        """The keys of each bone, in the order of the rig's."""
        found: dict[int, Spline] = {}
        for group, ends, spline in zip(self.groups, self._ends, self.splines, strict=True):
            starts = [0, *ends[:-1]]
            for bone, first, last in zip(group, starts, ends, strict=True):
                found[bone] = spline.columns(first, last)
        return tuple(found[bone] for bone in range(len(self.rig.bones)))

    def insert(self, group: int, frames: IndexArray, everywhere: bool) -> None:
        """Add keys to a group and fit all its keys anew, or only those near the new ones.

        A frame that is a key already is pinned: from now on the key has the target's own value.
        """
        again = np.intersect1d(frames, self.splines[group].keys)
        self.pinned[group] = np.union1d(self.pinned[group], again).astype(np.intp)
        spline, data = self.splines[group].with_keys(self.times, frames), self.data[group]
        last = len(spline.keys) - 1
        if everywhere:
            self.splines[group] = refit(self.times, data, spline, 0, last, self.pinned[group])
            return
        for at in np.searchsorted(spline.keys, frames):
            low, high = max(int(at) - REACH, 0), min(int(at) + REACH, last)
            spline = refit(self.times, data, spline, low, high, self.pinned[group])
        self.splines[group] = spline

    def without_key(self, group: int, frame: int) -> Trial:
        """The result without the group's key at a frame, its neighbors fitted anew."""
        at = int(np.searchsorted(self.splines[group].keys, frame))
        spline = self.splines[group].without_key(at)
        last = len(spline.keys) - 1
        low, high = max(at - REACH, 0), min(at + REACH - 1, last)
        spline = refit(self.times, self.data[group], spline, low, high, self.pinned[group])
        start, stop = int(spline.keys[max(low - 1, 0)]), int(spline.keys[min(high + 1, last)])
        frames = slice(start, stop + 1)
        changed = self._by_bone(group, spline.evaluate(self.times, start, stop))
        pose = self.rig.pose_changed(self.pose, frames, changed)
        distance = np.linalg.norm(pose.points - self.target.points[frames], axis=-1)
        return Trial(group, spline, frames, pose, float((distance / self.tolerance_m[frames]).max()))

    def accept(self, trial: Trial) -> None:
        """Adopt a trial."""
        self.splines[trial.group] = trial.spline
        self.pose.rotation[:, trial.frames] = trial.pose.rotation
        self.pose.points[trial.frames] = trial.pose.points

    def influence(self, group: int, off: BoolArray) -> Array:
        """(F,) largest displacement [m] that a group's own error gives the points that are `off` (F, P).

        To first order; 0 where the group is pinned already.
        """
        moved = np.zeros(len(self.times))
        for bone in self.groups[group]:
            moved = np.maximum(moved, np.where(off, self._moved_by(bone), 0.0).max(axis=1))
        moved[self.pinned[group]] = 0.0
        return moved

    def _moved_by(self, bone: int) -> Array:
        """(F, P) displacement of each point by a bone's own error [m]; 0 for those it does not carry."""
        rig, every = self.rig, slice(None)
        joint = rig.point_slices[bone].start
        error = self.pose.local(rig, bone, every) @ np.swapaxes(self.target.local(rig, bone, every), -1, -2)
        vector = rotations.logarithm(error)[:, None]  # (F, 1, 3) in the turner's frame
        shift = np.zeros_like(vector)
        turner, above = rig.bones[bone].turner, rig.bones[bone].parent
        if turner >= 0:
            vector = vector @ np.swapaxes(self.target.rotation[turner], -1, -2)
        if rig.bones[bone].location_axes is not None:
            shift = (self.pose.place(rig, bone, every) - self.target.place(rig, bone, every))[:, None]
            if above >= 0:
                shift = shift @ np.swapaxes(self.target.rotation[above], -1, -2)
        rows = [rig.point_slices[below] for below in rig.subtrees[bone]]
        carried = np.concatenate([np.arange(where.start, where.stop) for where in rows])
        arm = self.target.points[:, carried] - self.target.points[:, joint, None]
        moved = np.zeros(self.target.points.shape[:2])
        moved[:, carried] = np.linalg.norm(rotations.cross(vector, arm) + shift, axis=-1)
        return moved

    def _by_bone(self, group: int, values: Array) -> dict[int, Array]:
        parts = np.split(values, self._ends[group][:-1], axis=1)
        return dict(zip(self.groups[group], parts, strict=True))


# --- Key reduction


REMOVAL_MARGIN = 0.98  # share of the tolerance that removal may use: F-curves store numbers with few digits
ADDING_SHARE = 0.2  # share of the work that adding keys usually is
TRIALS_A_YIELD = 25  # removals tried between two reports of progress


@dataclass(frozen=True, eq=False)
class ReducedKeys:
    """Keys of every bone, and the error of the motion by them."""

    splines: tuple[Spline, ...]  # one a bone, in the order of the rig's bones
    furthest_m: float  # largest distance of any point from its original place, over all frames [m]


def reduce_keys(
    rig: Rig,
    times: Array,
    values: Sequence[Array],
    tolerance_m: float | Array,
    exact: IndexArray,
    whole_pose: bool = False,
) -> Generator[float, None, ReducedKeys]:
    """Find few keys whose curves keep all joints and ends within a tolerance.

    Args:
        rig: The bones that the values belong to.
        times: (F,) rising scene frames, at least two.
        values: For each bone of the rig its channels, (F, C), without jumps.
        tolerance_m: Largest distance of any point from its place by the values, in any frame [m]; or one for
            each frame and point, (F, P), in the order of `Rig.point_slices`.
        exact: Indices of frames that stay keys of every bone, with their values, as the first and last do.
        whole_pose: Whether all bones are keyed together, as poses; by default each bone where it needs keys.
    """
    bones = range(len(rig.bones))
    groups = [tuple(bones)] if whole_pose else [(bone,) for bone in bones]
    allowed = np.broadcast_to(tolerance_m, (len(times), rig.point_slices[-1].stop))
    body = KeyedBody(rig, times, values, allowed, np.unique(exact).astype(np.intp), groups)
    for done in _add_keys(body):
        yield ADDING_SHARE * done
    for done in _remove_keys(body):
        yield ADDING_SHARE + (1.0 - ADDING_SHARE) * done
    yield 1.0
    return ReducedKeys(body.bone_splines(), float(body.error_m().max()))


def _add_keys(body: KeyedBody) -> Generator[float, None, None]:
    """Add keys until the body has no error beyond the margin; yields the fraction done."""
    most = 0
    for number in count():
        # Share of the tolerance that added keys must reach; removal then chooses among them.
        off = body.error_m() > 0.5 * body.tolerance_m
        frames_off = int(off.any(axis=1).sum())
        if not frames_off:
            return
        most = max(most, frames_off)
        done = 1.0 - frames_off / most
        influence = []
        for group in range(len(body.groups)):
            influence.append(body.influence(group, off))
            yield done
        for group, frames in enumerate(_frames_for_keys(body, np.array(influence))):
            if len(frames):
                # Rounds in which all keys are fitted anew; later ones fit only the new keys' neighbors.
                body.insert(group, frames, everywhere=number < 3)
                yield done
        body.update()


def _frames_for_keys(body: KeyedBody, influence: Array) -> list[IndexArray]:
    """For each group the frames to key or pin, at most one between two keys."""
    most = influence.max(axis=0)
    chosen = []
    for spline, own in zip(body.splines, influence, strict=True):
        # A bone gets a key where its influence on a point is at least this share of the largest bone's.
        wanted = np.where(own >= 0.6 * most, own, 0.0)
        starts, stops = spline.keys, np.append(spline.keys[1:], len(wanted))
        found = [
            int(start) + int(np.argmax(wanted[start:stop]))
            for start, stop in zip(starts, stops, strict=True)
            if wanted[start:stop].max() > 0.0
        ]
        chosen.append(np.array(found, dtype=np.intp))
    return chosen


def _remove_keys(body: KeyedBody) -> Generator[float, None, None]:
    """Remove keys while the tolerance holds, the most dispensable first; yields the fraction done."""
    waiting: list[tuple[float, int, int]] = []
    candidates = [
        (group, int(frame))
        for group, spline in enumerate(body.splines)
        for frame in np.setdiff1d(spline.keys[1:-1], body.posed)
    ]
    for number, (group, frame) in enumerate(candidates):
        worst = body.without_key(group, frame).worst
        if worst <= REMOVAL_MARGIN:
            waiting.append((worst, group, frame))
        if number % TRIALS_A_YIELD == 0:
            yield 0.5 * number / len(candidates)
    heapq.heapify(waiting)
    judged, number = len(waiting), 0
    while waiting:
        _, group, frame = heapq.heappop(waiting)
        trial = body.without_key(group, frame)
        number += 1
        if trial.worst <= REMOVAL_MARGIN:
            # Ratio to the next candidate's error at which a removal goes back into the queue.
            if waiting and trial.worst > 1.02 * waiting[0][0]:
                heapq.heappush(waiting, (trial.worst, group, frame))
            else:
                body.accept(trial)
        if number % TRIALS_A_YIELD == 0:
            yield 0.5 + 0.5 * (1.0 - len(waiting) / judged)
