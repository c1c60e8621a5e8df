"""The ground under each foot: as high as its rests say, never above what the foot can stand on.

No floor is assumed: a foot may rest on a step or a beam. Between two rests the ground goes from one's height
to the other's. A foot that rests near where it, or the other one, has rested lower stands on its toes there.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from .contacts import NEIGHBORHOOD_S, Contact
from .foot_pitch import Shins, Soles

SETTLING_S = 0.1
"""Time from the beginning of a rest until the foot lies, and from when it begins to roll off to its end."""
ROLLING_S = 0.15
"""Time before and after a rest in which the foot is over the same ground, coming down or rolling off."""
SAME_PLACE_M = 0.12
"""Distance on the ground within which two rests are on one floor."""
HELD_M = 0.3
"""A foot that rests this much higher than the other one, which rests meanwhile, is held in the air."""
NOISE_M = 0.03
"""Two rests on one floor differ by no more than this unless one is on the toes."""
LOW_SHARE = 0.1
"""Where no foot ever rests, the ground is where the lower foot is for this share of the time."""


@dataclass(frozen=True, eq=False)
class FootGround:
    """The ground under both feet in F frames."""

    height_m: Array
    """(F, 2) height of the ground under the left and the right foot [m]."""
    resting: Array
    """(F, 2) how far the foot rests flat, 0 to 1."""
    on_toes: Array
    """(F, 2) how far it rests on its toes, 0 to 1."""


def find_ground(shins: Shins, soles: Soles, time_s: Array, contacts: Sequence[Contact]) -> FootGround:
    """Find the ground under both feet.

    Args:
        shins: The shins in F frames.
        soles: The soles under them.
        time_s: (F,) time of each frame [s].
        contacts: Rests of the ankles, 0 the left and 1 the right.
    """
    beneath = shins.ankle[..., 2] - soles.clearance_m(shins)
    own = [float(beneath[c.first : c.last + 1, c.point].mean()) for c in contacts]
    levels = [_floor(index, contacts, own) for index in range(len(contacts))]
    resting, on_toes = np.zeros_like(beneath), np.zeros_like(beneath)
    for contact, level, flat in zip(contacts, levels, own, strict=True):
        rows = slice(contact.first, contact.last + 1)
        weight = resting if flat - level < NOISE_M else on_toes
        weight[rows, contact.point] = _settled(time_s[rows])
    if contacts:
        height = np.stack([_between(foot, contacts, levels, time_s) for foot in range(2)], axis=-1)
    else:
        height = np.repeat(_lower_foot(beneath, time_s)[:, None], 2, axis=-1)
    # A rest's own height is that of its ankle in every frame: what the ankle errs by, the ground has.
    height = (1.0 - resting) * height + resting * beneath
    return FootGround(np.minimum(height, beneath), resting, on_toes)


def on_ground(contacts: Sequence[Contact]) -> tuple[Contact, ...]:
    """The rests of feet that are not just held still in the air."""

    def beside(contact: Contact, other: Contact) -> bool:
        shared = min(contact.last, other.last) - max(contact.first, other.first)
        return other.point != contact.point and 2 * shared > contact.last - contact.first

    return tuple(
        contact
        for contact in contacts
        if not any(
            beside(contact, other) and contact.place[2] - other.place[2] > HELD_M for other in contacts
        )
    )


def _floor(index: int, contacts: Sequence[Contact], own: Sequence[float]) -> float:
    """The ground's height at a rest: the lowest of those at the same place, if it is well below."""
    here = contacts[index].place[:2]
    near = [
        height
        for contact, height in zip(contacts, own, strict=True)
        if np.linalg.norm(contact.place[:2] - here) < SAME_PLACE_M
    ]
    return min(near) if own[index] - min(near) >= NOISE_M else own[index]


def _settled(time_s: Array) -> Array:
    """(N,) rises from 0 at a rest's beginning to 1, and falls to 0 at its end."""
    edge = np.minimum(time_s - time_s[0], time_s[-1] - time_s) / SETTLING_S
    return smooth_step(edge)


def _between(foot: int, contacts: Sequence[Contact], levels: Sequence[float], time_s: Array) -> Array:
    """(F,) the ground under a foot: at its rests, and beyond them at the other foot's."""
    rests = [(c, level) for c, level in zip(contacts, levels, strict=True) if c.point == foot]
    if rests:
        first, last = min(c.first for c, _ in rests), max(c.last for c, _ in rests)
    else:
        first, last = len(time_s), -1
    rests += [
        (c, level)
        for c, level in zip(contacts, levels, strict=True)
        if c.point != foot and (c.last < first or c.first > last)
    ]
    rests.sort(key=lambda rest: rest[0].first)
    height = np.full(len(time_s), rests[0][1])
    for (before, low), (after, high) in zip(rests, rests[1:], strict=False):
        start, stop = time_s[before.last], time_s[after.first]
        rolling = min(ROLLING_S, (stop - start) / 3.0)
        share = (time_s - start - rolling) / max(stop - start - 2.0 * rolling, 1e-9)
        height[before.last :] = low + (high - low) * smooth_step(share[before.last :])
    return height


def _lower_foot(beneath: Array, time_s: Array) -> Array:
    """(F,) where the lower foot is for a share of the time around each frame."""
    lower = beneath.min(axis=1)
    edges = np.searchsorted(time_s, [time_s - NEIGHBORHOOD_S, time_s + NEIGHBORHOOD_S])
    return np.array([np.quantile(lower[a : b + 1], LOW_SHARE) for a, b in edges.T], dtype=np.float64)


def smooth_step(share: Array) -> Array:
    """0 below 0, 1 above 1, and smooth in between."""
    s = np.clip(share, 0.0, 1.0)
    return np.asarray(s * s * (3.0 - 2.0 * s))
