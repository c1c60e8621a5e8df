"""Contacts of feet: where an ankle is slow, near one place and low, whatever ground that is on."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray

RELEASE_SPEED_M_S = 0.25  # below this a foot may rest; once it must be slower than half of it
NEIGHBORHOOD_S = 1.0
STRAY_M = 0.025  # largest distance of a resting ankle's estimate from its place


@dataclass(frozen=True, eq=False)
class Contact:
    """A foot at rest."""

    point: int  # index of the point that rests
    first: int  # the first frame of the rest, from 0
    last: int  # its last frame, included
    place: Array  # (3,) its place [m]


def find_contacts(places: Array, time_s: Array, stray_m: float = STRAY_M) -> tuple[Contact, ...]:
    """Find the contacts of points (F, N, 3) [m], in order of point and frame.

    No floor is assumed: a foot may rest on a step or a beam. One that sways or slides farther than it may
    stray does not rest. A rest on a step begins when the point comes there, though its way there still tells
    that it is high.
    """
    if len(places) < 3:
        return ()
    speed = np.linalg.norm(np.gradient(places, time_s, axis=0), axis=-1)
    found: list[Contact] = []
    for point in range(places.shape[1]):
        path, own = places[:, point], speed[:, point]
        # On stairs a foot that carries the body may be high, while the other one is faster than this.
        carries = np.delete(speed, point, axis=1).max(axis=1, initial=0.0) > 0.5
        may_rest = carries | _is_low(path, time_s)
        free = 0
        for run in _slow_runs(own, may_rest):
            first, last = _longest_rest(path, stray_m, *run)
            lasted, whole = time_s[last] - time_s[first], time_s[run[1]] - time_s[run[0]]
            # Shortest rest; shorter ones are turning points of a moving foot.
            # Least share of a slow run that a rest takes; a foot that is slow but does not stay slides.
            if lasted >= max(0.2, 0.6 * whole):
                place = path[first : last + 1].mean(axis=0)
                near = np.linalg.norm(path - place, axis=-1) <= stray_m
                rest = _widened(~may_rest & near & (own < RELEASE_SPEED_M_S), first, last, free)
                found.append(Contact(point, *rest, place))
                free = rest[1] + 1
    return tuple(found)


def _is_low(path: Array, time_s: Array) -> BoolArray:
    """(F,) whether a point is near its own lowest."""
    low = np.array(
        [path[np.abs(time_s - now) <= NEIGHBORHOOD_S, 2].min() for now in time_s], dtype=np.float64
    )
    return np.asarray(path[:, 2] - low < 0.05)


def _widened(stays: BoolArray, first: int, last: int, free: int) -> tuple[int, int]:
    """The range of frames (first, last) with the frames from `free` on beside it in which the point stays."""
    while first > free and stays[first - 1]:
        first -= 1
    while last < len(stays) - 1 and stays[last + 1]:
        last += 1
    return first, last


def _slow_runs(speed: Array, may_rest: BoolArray) -> list[tuple[int, int]]:
    """Runs of frames (first, last) that stay below the release speed and somewhere rest."""
    slow = (speed < RELEASE_SPEED_M_S) & may_rest
    edges = np.flatnonzero(np.diff(np.concatenate([[0], slow.astype(np.intp), [0]])))
    runs = zip(edges[::2], edges[1::2] - 1, strict=True)
    return [(int(a), int(b)) for a, b in runs if speed[a : b + 1].min() < 0.12]


def _longest_rest(path: Array, stray_m: float, first: int, last: int) -> tuple[int, int]:
    """The longest part of a run that stays near its own mean place."""
    longest = (first, first)
    start = first
    for stop in range(first + 1, last + 1):
        while not _stays(path[start : stop + 1], stray_m):
            start += 1
        if stop - start > longest[1] - longest[0]:
            longest = (start, stop)
    return longest


def _stays(path: Array, stray_m: float) -> bool:
    return bool((np.linalg.norm(path - path.mean(axis=0), axis=-1) <= stray_m).all())
