"""Contacts of feet: where an ankle is slow, near one place and low, whatever ground that is on."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.skeleton import SIDES
from ..numerics.vectors import runs

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

    @property
    def frames(self) -> slice:
        """Its frames."""
        return slice(self.first, self.last + 1)

    @property
    def leg(self) -> str:
        """The limb whose foot rests, where points are counted left, right."""
        return f"leg.{SIDES[self.point]}"


def find_contacts(places: Array, time_s: Array, stray_m: float = STRAY_M) -> tuple[Contact, ...]:
    """Find the contacts of points (F, N, 3) [m], in order of point and frame.

    No floor is assumed: a foot may rest on a step or a beam. One that sways or slides farther than it may
    stray does not rest, nor one that is held still high above the other. A rest on a step begins when the
    point comes there, though its way there still tells that it is high.
    """
    if len(places) < 3:
        return ()
    speed = speeds(places, time_s)
    found: list[Contact] = []
    for point in range(places.shape[1]):
        path, own = places[:, point], speed[:, point]
        # On stairs a foot that carries the body may be high, while the other one is faster than this.
        carries = np.delete(speed, point, axis=1).max(axis=1, initial=0.0) > 0.5
        may_rest = carries | (over_lowest(path[:, 2], time_s) < 0.05)
        free = 0
        for start, stop in runs((own < RELEASE_SPEED_M_S) & may_rest):
            if own[start:stop].min() >= 0.12:
                continue
            first, last = _longest_rest(path, stray_m, start, stop - 1)
            lasted, whole = time_s[last] - time_s[first], time_s[stop - 1] - time_s[start]
            # Shortest rest; shorter ones are turning points of a moving foot.
            # Least share of a slow run that a rest takes; a foot that is slow but does not stay slides.
            if lasted >= max(0.2, 0.6 * whole):
                place = path[first : last + 1].mean(axis=0)
                near = np.linalg.norm(path - place, axis=-1) <= stray_m
                stays = ~may_rest & near & (own < RELEASE_SPEED_M_S)
                while first > free and stays[first - 1]:
                    first -= 1
                while last < len(stays) - 1 and stays[last + 1]:
                    last += 1
                found.append(Contact(point, first, last, place))
                free = last + 1
    return tuple(contact for contact in found if not any(_is_over(contact, other) for other in found))


def speeds(paths: Array, time_s: Array) -> Array:
    """(F, ...) speed along paths (F, ..., 3) [m/s]."""
    if len(paths) < 2:
        return np.zeros(paths.shape[:-1])
    return np.asarray(np.linalg.norm(np.gradient(paths, time_s, axis=0), axis=-1))


def over_lowest(height: Array, time_s: Array) -> Array:
    """(F,) how much higher a point is than where it is lowest within a second."""
    low = [height[np.abs(time_s - now) <= NEIGHBORHOOD_S].min() for now in time_s]
    return height - np.array(low, dtype=np.float64)


def _is_over(contact: Contact, other: Contact) -> bool:
    """Whether a foot is held in the air: high over another one that rests meanwhile."""
    shared = min(contact.last, other.last) - max(contact.first, other.first)
    meanwhile = other.point != contact.point and 2 * shared > contact.last - contact.first
    return meanwhile and bool(contact.place[2] - other.place[2] > 0.3)


def _longest_rest(path: Array, stray_m: float, first: int, last: int) -> tuple[int, int]:
    """The longest part of a run that stays near its own mean place."""
    longest = (first, first)
    start = first
    for stop in range(first + 1, last + 1):
        while True:
            part = path[start : stop + 1]
            if (np.linalg.norm(part - part.mean(axis=0), axis=-1) <= stray_m).all():
                break
            start += 1
        if stop - start > longest[1] - longest[0]:
            longest = (start, stop)
    return longest
