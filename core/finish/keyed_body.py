"""A body's motion held by keys: curves of groups of bones, what they show, and how far off that is."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body import rotations
from .hermite import Spline, fit_keys, refit
from .rig import Rig, Shown

REACH = 3
"""How many keys on either side of a new or removed one are fitted anew."""


@dataclass(frozen=True, eq=False)
class Trial:
    """What would be without one of the keys."""

    group: int
    spline: Spline
    frames: slice
    """Where it would show."""
    shown: Shown
    worst: float
    """The largest distance of any point from its goal there, in units of its tolerance."""


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
            values: For each bone its channels, (F, C): the goal.
            tolerance_m: (F, P) how far each of the rig's points may be from its goal in each frame [m].
            exact: Positions of frames that stay keys, with their own values.
            groups: Positions of bones, each bone in one group.
        """
        self.rig, self.times, self.posed, self.groups = rig, times, exact, groups
        self.pinned = [exact for _ in groups]
        """For each group the frames at which its keys have the goal's own values."""
        self.tolerance_m = tolerance_m
        self.data = [np.concatenate([values[bone] for bone in group], axis=1) for group in groups]
        self._ends = [np.cumsum([values[bone].shape[1] for bone in group]) for group in groups]
        self.goal = rig.show(list(values))
        keys = np.union1d([0, len(times) - 1], exact).astype(np.intp)
        self.splines = [fit_keys(times, data, keys, exact) for data in self.data]
        self.show()

    def show(self) -> None:
        """Evaluate all curves and the body they show."""
        values: dict[int, Array] = {}
        for group, spline in enumerate(self.splines):
            values |= self._by_bone(group, spline.evaluate(self.times, 0, len(self.times) - 1))
        self.shown = self.rig.show([values[bone] for bone in range(len(self.rig.bones))])

    def distance_m(self) -> Array:
        """(F, P) how far each point is from its goal [m]."""
        return np.asarray(np.linalg.norm(self.shown.points - self.goal.points, axis=-1))

    def strain(self) -> Array:
        """(F, P) the same in units of each point's tolerance."""
        return self.distance_m() / self.tolerance_m

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

        A frame that is a key already is pinned: from now on the key has the goal's own value.
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

    def without(self, group: int, frame: int) -> Trial:
        """What would be without the group's key at a frame, its neighbors fitted anew."""
        at = int(np.searchsorted(self.splines[group].keys, frame))
        spline = self.splines[group].without_key(at)
        last = len(spline.keys) - 1
        low, high = max(at - REACH, 0), min(at + REACH - 1, last)
        spline = refit(self.times, self.data[group], spline, low, high, self.pinned[group])
        start, stop = int(spline.keys[max(low - 1, 0)]), int(spline.keys[min(high + 1, last)])
        frames = slice(start, stop + 1)
        changed = self._by_bone(group, spline.evaluate(self.times, start, stop))
        shown = self.rig.show_changed(self.shown, frames, changed)
        distance = np.linalg.norm(shown.points - self.goal.points[frames], axis=-1)
        return Trial(group, spline, frames, shown, float((distance / self.tolerance_m[frames]).max()))

    def accept(self, trial: Trial) -> None:
        """Let what was tried be so."""
        self.splines[trial.group] = trial.spline
        self.shown.rotation[:, trial.frames] = trial.shown.rotation
        self.shown.points[trial.frames] = trial.shown.points

    def blame(self, group: int, off: BoolArray) -> Array:
        """How far a group's own error moves a point that is off.

        Args:
            group: Whose error.
            off: (F, P) which points are off.

        Returns:
            (F,) [m], to first order; 0 where the group is pinned and nothing more can be done.
        """
        moved = np.zeros(len(self.times))
        for bone in self.groups[group]:
            moved = np.maximum(moved, np.where(off, self._moved_by(bone), 0.0).max(axis=1))
        moved[self.pinned[group]] = 0.0
        return moved

    def _moved_by(self, bone: int) -> Array:
        """(F, P) how far a bone's own error moves each point [m]; 0 for those it does not carry."""
        rig, every = self.rig, slice(None)
        joint = rig.point_slices[bone].start
        error = self.shown.local(rig, bone, every) @ np.swapaxes(self.goal.local(rig, bone, every), -1, -2)
        vector = rotations.logarithm(error)[:, None]  # (F, 1, 3) in the parent's frame
        shift = np.zeros_like(vector)
        above = rig.bones[bone].parent
        if above >= 0:
            vector = vector @ np.swapaxes(self.goal.rotation[above], -1, -2)
        else:
            shift = (self.shown.points - self.goal.points)[:, joint, None]
        carried = np.concatenate(
            [np.arange(where.start, where.stop) for where in (rig.point_slices[b] for b in rig.below[bone])]
        )
        arm = self.goal.points[:, carried] - self.goal.points[:, joint, None]
        moved = np.zeros(self.goal.points.shape[:2])
        moved[:, carried] = np.linalg.norm(rotations.cross(vector, arm) + shift, axis=-1)
        return moved

    def _by_bone(self, group: int, values: Array) -> dict[int, Array]:
        parts = np.split(values, self._ends[group][:-1], axis=1)
        return dict(zip(self.groups[group], parts, strict=True))
