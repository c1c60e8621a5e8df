"""Key reduction: as few keys as keep every point of the body within a tolerance in every frame.

Keys are first added where the body has an error, more than needed, and then removed, the most dispensable
first, as long as the body stays within the tolerance. The error is that of the body in the world, not of the
curves: a degree at the hips moves a hand further than one at the elbow, and errors along a limb add up or
cancel. Between keys lie the cubics of `hermite`, fitted to all frames, so that the noise of single frames is
smoothed and not keyed.
"""

import heapq
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from itertools import count

import numpy as np

from ..arrays import Array, IndexArray
from .hermite import Spline
from .keyed_body import KeyedBody
from .rig import Rig

ADDING_MARGIN = 0.5
"""Share of the tolerance that added keys must reach; removal then chooses among them."""
INFLUENCE_SHARE = 0.6
"""A bone gets a key where its influence on a point is at least this share of the largest bone's."""
GLOBAL_ROUNDS = 3
"""Rounds in which all keys are fitted anew; later ones fit only the new keys' neighbors."""
REMOVAL_MARGIN = 0.98
"""Share of the tolerance that removal may use: F-curves store numbers with few digits."""
REQUEUE_RATIO = 1.02
"""Ratio to the next candidate's error at which a removal goes back into the queue."""
ADDING_SHARE = 0.2
"""Share of the work that adding keys usually is."""
TRIALS_A_YIELD = 25
"""Removals tried between two reports of progress."""


@dataclass(frozen=True, eq=False)
class ReducedKeys:
    """Keys of every bone, and the error of the motion by them."""

    splines: tuple[Spline, ...]
    """One a bone, in the order of the rig's bones."""
    furthest_m: float
    """Largest distance of any point from its original place, over all frames [m]."""


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
        exact: Indices of frames that stay keys of every bone, with their values.
        whole_pose: Whether all bones are keyed together, as poses; by default each bone where it needs keys.

    Yields:
        The fraction done, from 0 to 1.

    Returns:
        The keys. The first and the last frame are always among them.
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
        off = body.normalized_error() > ADDING_MARGIN
        frames_off = int(off.any(axis=1).sum())
        if not frames_off:
            return
        most = max(most, frames_off)
        done = 1.0 - frames_off / most
        influence = np.empty((len(body.groups), len(body.times)))
        for group in range(len(body.groups)):
            influence[group] = body.influence(group, off)
            yield done
        for group, frames in enumerate(_frames_for_keys(body, influence)):
            if len(frames):
                body.insert(group, frames, everywhere=number < GLOBAL_ROUNDS)
                yield done
        body.update()


def _frames_for_keys(body: KeyedBody, influence: Array) -> list[IndexArray]:
    """For each group the frames to key or pin, at most one between two keys."""
    most = influence.max(axis=0)
    chosen = []
    for spline, own in zip(body.splines, influence, strict=True):
        wanted = np.where(own >= INFLUENCE_SHARE * most, own, 0.0)
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
            if waiting and trial.worst > REQUEUE_RATIO * waiting[0][0]:
                heapq.heappush(waiting, (trial.worst, group, frame))
            else:
                body.accept(trial)
        if number % TRIALS_A_YIELD == 0:
            yield 0.5 + 0.5 * (1.0 - len(waiting) / judged)
