"""Fewer keys: as few as keep every point of the body within a tolerance of where it was, in every frame.

Keys are first added where the body is off, more than needed, and then taken away, the most dispensable
first, as long as the body stays within the tolerance. What counts is the body in the world, not the curves:
a degree at the hips moves a hand further than one at the elbow, and errors along a limb add up or cancel.
Between keys lie the cubics of `hermite`, fitted to all frames, so that the noise of single frames is
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

GENEROUS = 0.5
"""Share of the tolerance within which keys are added first: the choice among them comes by taking away."""
BLAME = 0.6
"""A bone gets a key where its own error is at least this share of the largest that adds to a point's."""
ROUNDS_EVERYWHERE = 3
"""In the first rounds all keys are fitted anew, afterwards only the new ones' neighbors."""
MARGIN = 0.98
"""Share of the tolerance to which keys are taken away: F-curves store numbers with few digits."""
SAME = 1.02
"""A key whose removal has become this much worse since it was judged has to wait its turn again."""
ADDING_SHARE = 0.2
"""Share of the work that adding keys usually is."""
TRIALS = 25
"""Removals tried between two reports of progress."""


@dataclass(frozen=True, eq=False)
class ReducedKeys:
    """Keys of every bone, and how well they hold the motion."""

    splines: tuple[Spline, ...]
    """One a bone, in the order of the rig's bones."""
    furthest_m: float
    """The largest distance of any point from where it was, over all frames [m]."""


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
        tolerance_m: Largest distance of any point from where the values put it, in any of the frames [m]; or
            one for each frame and point, (F, P), in the order of `Rig.point_slices`.
        exact: Positions of frames that stay keys of every bone, with their values.
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
    for done in _take_keys_away(body):
        yield ADDING_SHARE + (1.0 - ADDING_SHARE) * done
    yield 1.0
    return ReducedKeys(body.bone_splines(), float(body.distance_m().max()))


def _add_keys(body: KeyedBody) -> Generator[float, None, None]:
    """Add keys where the body is off, until it nowhere is; yields the fraction done."""
    most = 0
    for number in count():
        off = body.strain() > GENEROUS
        frames_off = int(off.any(axis=1).sum())
        if not frames_off:
            return
        most = max(most, frames_off)
        done = 1.0 - frames_off / most
        blame = np.empty((len(body.groups), len(body.times)))
        for group in range(len(body.groups)):
            blame[group] = body.blame(group, off)
            yield done
        for group, frames in enumerate(_places_for_keys(body, blame)):
            if len(frames):
                body.insert(group, frames, everywhere=number < ROUNDS_EVERYWHERE)
                yield done
        body.show()


def _places_for_keys(body: KeyedBody, blame: Array) -> list[IndexArray]:
    """For each group the frames that should become keys, or be pinned, at most one from key to key."""
    most = blame.max(axis=0)
    places = []
    for spline, own in zip(body.splines, blame, strict=True):
        wanted = np.where(own >= BLAME * most, own, 0.0)
        starts, stops = spline.keys, np.append(spline.keys[1:], len(wanted))
        found = [
            int(start) + int(np.argmax(wanted[start:stop]))
            for start, stop in zip(starts, stops, strict=True)
            if wanted[start:stop].max() > 0.0
        ]
        places.append(np.array(found, dtype=np.intp))
    return places


def _take_keys_away(body: KeyedBody) -> Generator[float, None, None]:
    """Take away keys while the tolerance holds, the least missed first; yields the fraction done."""
    waiting: list[tuple[float, int, int]] = []
    candidates = [
        (group, int(frame))
        for group, spline in enumerate(body.splines)
        for frame in np.setdiff1d(spline.keys[1:-1], body.posed)
    ]
    for number, (group, frame) in enumerate(candidates):
        worst = body.without(group, frame).worst
        if worst <= MARGIN:
            waiting.append((worst, group, frame))
        if number % TRIALS == 0:
            yield 0.5 * number / len(candidates)
    heapq.heapify(waiting)
    judged, number = len(waiting), 0
    while waiting:
        _, group, frame = heapq.heappop(waiting)
        trial = body.without(group, frame)
        number += 1
        if trial.worst <= MARGIN:
            if waiting and trial.worst > SAME * waiting[0][0]:
                heapq.heappush(waiting, (trial.worst, group, frame))
            else:
                body.accept(trial)
        if number % TRIALS == 0:
            yield 0.5 + 0.5 * (1.0 - len(waiting) / judged)
