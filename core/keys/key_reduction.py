"""Key reduction: few keys whose curves keep all joints and ends of a body within a tolerance."""

import heapq
from collections.abc import Generator, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray, chunks
from ..body import rotations
from .hermite import Spline, fit_keys, refit, without_each
from .rig import Rig, RigPose

REACH = 3  # number of keys on either side of a removed one that are fitted anew
REMOVAL_MARGIN = 0.98  # share of the tolerance that removal may use: F-curves store numbers with few digits
TRIALS_A_YIELD = 25  # removals tried between two reports of progress
TRIALS_AT_ONCE = 100  # removals tried together, which bounds their memory


@dataclass(frozen=True, eq=False)
class Trial:
    """The curves and their pose without one of the keys."""

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
        """Keys at the first, the last and the exact frames only, which stay keys with their values.

        The target are values (F, C) for each bone at rising times (F,), which the rig's points keep within
        (F, P) [m]; each bone is in one of the groups.
        """
        self.rig, self.times, self.posed, self.groups = rig, times, exact, groups
        self.pinned = [exact for _ in groups]
        """For each group the frames at which its keys have the target's own values."""
        self.tolerance_m = tolerance_m
        self.data = [np.concatenate([values[bone] for bone in group], axis=1) for group in groups]
        self._ends = [np.cumsum([values[bone].shape[1] for bone in group])[:-1] for group in groups]
        self.target = rig.pose(list(values))
        keys = np.union1d([0, len(times) - 1], exact).astype(np.intp)
        self.splines = [fit_keys(times, data, keys, exact) for data in self.data]

    def update(self) -> Array:
        """Evaluate all curves and the pose they give; (F, P) distance of each point from its target [m]."""
        last = len(self.times) - 1
        self.pose = self.rig.pose([one.evaluate(self.times, 0, last) for one in self.bone_splines()])
        return np.asarray(np.linalg.norm(self.pose.points - self.target.points, axis=-1))

    def bone_splines(self) -> tuple[Spline, ...]:
        """The keys of each bone, in the order of the rig's."""
        found: dict[int, Spline] = {}
        for group, ends, one in zip(self.groups, self._ends, self.splines, strict=True):
            values, slopes = (np.split(held, ends, axis=1) for held in (one.values, one.slopes))
            for bone, value, slope in zip(group, values, slopes, strict=True):
                found[bone] = Spline(one.keys, value, slope)
        return tuple(found[bone] for bone in range(len(self.rig.bones)))

    def insert(self, group: int, frames: IndexArray) -> None:
        """Add keys to a group and fit all its keys anew.

        A frame that is a key already is pinned: from now on the key has the target's own value.
        """
        again = np.intersect1d(frames, self.splines[group].keys)
        self.pinned[group] = np.union1d(self.pinned[group], again).astype(np.intp)
        keys = np.union1d(self.splines[group].keys, frames).astype(np.intp)
        self.splines[group] = fit_keys(self.times, self.data[group], keys, self.pinned[group])

    def without_key(self, group: int, frame: int) -> Trial:
        """The result without the group's key at a frame, its neighbors fitted anew."""
        at = int(np.searchsorted(self.splines[group].keys, frame))
        spline = self.splines[group].without_key(at)
        last = len(spline.keys) - 1
        low, high = max(at - REACH, 0), min(at + REACH - 1, last)
        spline = refit(self.times, self.data[group], spline, low, high, self.pinned[group])
        start, stop = int(spline.keys[max(low - 1, 0)]), int(spline.keys[min(high + 1, last)])
        frames = slice(start, stop + 1)
        values = np.split(spline.evaluate(self.times, start, stop), self._ends[group], axis=1)
        changed = dict(zip(self.groups[group], values, strict=True))
        pose = self.rig.pose_changed(self.pose, frames, changed)
        distance = np.linalg.norm(pose.points - self.target.points[frames], axis=-1)
        return Trial(spline, frames, pose, float((distance / self.tolerance_m[frames]).max()))

    def worst_without(self, group: int, frames: IndexArray) -> Array:
        """(T,) the largest error that each of the group's keys at some frames leaves if it alone goes."""
        spline = self.splines[group]
        at = np.searchsorted(spline.keys, frames)
        inner = (at > REACH) & (at < len(spline.keys) - 1 - REACH)
        worst = np.empty(len(frames))
        worst[~inner] = [self.without_key(group, int(frame)).worst for frame in frames[~inner]]
        if inner.any():
            exact = self.pinned[group]
            rows, starts, shown = without_each(self.times, self.data[group], spline, at[inner], exact, REACH)
            values = np.split(shown, self._ends[group], axis=1)
            changed = dict(zip(self.groups[group], values, strict=True))
            points = self.rig.pose_changed(self.pose, rows, changed).points
            distance = np.linalg.norm(points - self.target.points[rows], axis=-1)
            worst[inner] = np.maximum.reduceat((distance / self.tolerance_m[rows]).max(axis=1), starts)
        return worst

    def influence(self, group: int, off: BoolArray) -> Array:
        """(F,) largest displacement [m] that a group's own error gives the points that are `off` (F, P).

        To first order; 0 where the group is pinned already, and for points that it does not carry.
        """
        rig, every = self.rig, slice(None)
        found = np.zeros(len(self.times))
        for bone in self.groups[group]:
            joint = rig.point_slices[bone].start
            wanted = np.swapaxes(self.target.local(rig, bone, every), -1, -2)
            vector = rotations.logarithm(self.pose.local(rig, bone, every) @ wanted)[:, None]  # (F, 1, 3)
            shift = np.zeros_like(vector)
            turner, above = rig.bones[bone].turner, rig.bones[bone].parent
            if turner >= 0:  # from its turner's frame
                vector = vector @ np.swapaxes(self.target.rotation[turner], -1, -2)
            if rig.bones[bone].location_axes is not None:
                shift = (self.pose.place(rig, bone, every) - self.target.place(rig, bone, every))[:, None]
                if above >= 0:
                    shift = shift @ np.swapaxes(self.target.rotation[above], -1, -2)
            rows = [rig.point_slices[below] for below in rig.subtrees[bone]]
            carried = np.concatenate([np.arange(where.start, where.stop) for where in rows])
            arm = self.target.points[:, carried] - self.target.points[:, joint, None]
            moved = np.linalg.norm(rotations.cross(vector, arm) + shift, axis=-1)
            found = np.maximum(found, np.where(off[:, carried], moved, 0.0).max(axis=1))
        found[self.pinned[group]] = 0.0
        return found


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

    Each bone has values (F, C) without jumps at rising scene frames (F,), at least two. The tolerance is the
    largest distance of a point from its place by them [m], or one a frame and point (F, P) in the order of
    `Rig.point_slices`. The `exact` frames, by index, stay keys as the first and the last do. With
    `whole_pose` all bones are keyed together, by default each where it needs keys.
    """
    bones = range(len(rig.bones))
    groups = [tuple(bones)] if whole_pose else [(bone,) for bone in bones]
    allowed = np.broadcast_to(tolerance_m, (len(times), rig.point_slices[-1].stop))
    body = KeyedBody(rig, times, values, allowed, np.unique(exact).astype(np.intp), groups)
    for done in _add_keys(body):
        yield 0.2 * done
    for done in _remove_keys(body):
        yield 0.2 + 0.8 * done
    return ReducedKeys(body.bone_splines(), float(body.update().max()))


def _add_keys(body: KeyedBody) -> Generator[float, None, None]:
    """Add keys until the body has no error beyond the margin; yields the fraction done."""
    most = 0
    while True:
        # Share of the tolerance that added keys must reach; removal then chooses among them.
        off = body.update() > 0.5 * body.tolerance_m
        frames_off = int(off.any(axis=1).sum())
        if not frames_off:
            return
        most = max(most, frames_off)
        yield 1.0 - frames_off / most
        influence = np.array([body.influence(group, off) for group in range(len(body.groups))])
        # A bone gets a key where its influence on a point is at least this share of the largest bone's.
        wanted = np.where(influence >= 0.6 * influence.max(axis=0), influence, 0.0)
        for group, own in enumerate(wanted):
            # At most one new or pinned frame between two keys: the first of the largest.
            starts = body.splines[group].keys
            piece = np.searchsorted(starts, np.arange(len(own)), side="right") - 1
            largest = np.flatnonzero((own > 0.0) & (own == np.maximum.reduceat(own, starts)[piece]))
            frames = largest[np.unique(piece[largest], return_index=True)[1]]
            if len(frames):
                body.insert(group, frames)
                yield 1.0 - frames_off / most


def _remove_keys(body: KeyedBody) -> Generator[float, None, None]:
    """Remove keys while the tolerance holds, the most dispensable first; yields the fraction done."""
    waiting: list[tuple[float, int, int]] = []
    for group, spline in enumerate(body.splines):
        for frames in chunks(np.setdiff1d(spline.keys[1:-1], body.posed), TRIALS_AT_ONCE):
            worst = body.worst_without(group, frames)
            waiting += [
                (float(own), group, int(frame))
                for own, frame in zip(worst, frames, strict=True)
                if own <= REMOVAL_MARGIN
            ]
            yield 0.3 * group / len(body.splines)
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
                body.splines[group] = trial.spline
                body.pose.rotation[:, trial.frames] = trial.pose.rotation
                body.pose.points[trial.frames] = trial.pose.points
        if number % TRIALS_A_YIELD == 0:
            yield 0.3 + 0.7 * (1.0 - len(waiting) / judged)
