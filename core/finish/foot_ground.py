"""Shins and the rigid soles under them: the pitches that keep a foot above the ground and within its range.

The orientation of a shin or foot is taken apart as Rz(heading) Ry(roll) Rx(pitch) of the one at rest; a
positive pitch points the toes down. All arrays are of left and right on the axis after the frames.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import convolve1d, maximum_filter1d

from ..arrays import Array
from ..body.body_volume import sole_offsets
from ..body.kinematics import Body, Pose
from ..body.skeleton import SIDES
from .contacts import NEIGHBORHOOD_S, Contact

TOES_UP_RAD = np.radians(50.0)
"""Dorsiflexion of a loaded ankle: about 40 degrees in a lunge (Bennell et al. 1998, *Australian Journal of
Physiotherapy* 44), widened by a quarter as the joint limits of the body are."""
TOES_DOWN_RAD = np.radians(60.0)  # plantarflexion: 50 degrees (AAOS 1965, *Joint Motion*), widened likewise


@dataclass(frozen=True, eq=False)
class Shins:
    """Both shins in F frames."""

    heading: Array  # (F, 2) [rad]; `roll` and `pitch` likewise
    roll: Array
    pitch: Array
    ankle: Array  # (F, 2, 3) its lower end [m]

    @classmethod
    def of(cls, body: Body, pose: Pose) -> "Shins":
        """The shins of F poses."""
        feet = [next(s for s in body.skeleton.segments if s.name == f"foot.{side}") for side in SIDES]
        rotation = np.stack([pose.rotation[:, foot.joint] for foot in feet], axis=1)
        return cls(
            np.arctan2(rotation[..., 1, 0], rotation[..., 0, 0]),
            -np.arcsin(np.clip(rotation[..., 2, 0], -1.0, 1.0)),
            np.arctan2(rotation[..., 2, 1], rotation[..., 2, 2]),
            np.stack([pose.place(foot.joint, body.local(foot.start)) for foot in feet], axis=1),
        )

    @property
    def lowest_pitch(self) -> Array:
        """(F, 2) pitch of a foot whose toes are up as far as the ankle lets them."""
        return self.pitch - TOES_UP_RAD

    @property
    def highest_pitch(self) -> Array:
        """(F, 2) pitch of a foot whose toes are down as far as the ankle lets them."""
        return self.pitch + TOES_DOWN_RAD


@dataclass(frozen=True, eq=False)
class Soles:
    """Heel and tip of both feet in their sagittal planes: distance from the ankle, and angle below level."""

    heel_m: Array  # (2,) of the left and the right foot [m]
    heel_rad: Array  # (2,) angle of the line from ankle to heel below the level one backward
    tip_m: Array
    tip_rad: Array

    @classmethod
    def of(cls, body: Body) -> "Soles":
        """The soles of a body."""
        heel, tip = np.moveaxis(sole_offsets(body), 1, 0)
        return cls(
            np.hypot(heel[:, 1], heel[:, 2]),
            np.arctan2(-heel[:, 2], heel[:, 1]),
            np.hypot(tip[:, 1], tip[:, 2]),
            np.arctan2(-tip[:, 2], -tip[:, 1]),
        )

    @property
    def flat_m(self) -> Array:
        """(2,) height of an ankle above its flat sole [m]."""
        return self._depth_m(np.zeros(2))

    def clearance_m(self, shins: Shins) -> Array:
        """(F, 2) least height of an ankle above the ground: a flat foot's, if it can lie flat [m]."""
        low, high = shins.lowest_pitch, shins.highest_pitch
        depths = [self._depth_m(pitch) for pitch in (np.clip(0.0, low, high), low, high)]
        # A foot that lies on its back or side is at least that thick.
        return np.asarray(np.maximum(np.minimum.reduce(depths), 0.02))

    def above_ground(self, pitch: Array, height_m: Array, level: Array, shins: Shins) -> Array:
        """As `ahead`, but toes that the ankle cannot bring up in front of the shin go behind it."""
        _, most = self._range(height_m, level)
        # Behind, the tip is as steep as in front.
        behind = np.maximum(pitch, np.pi - most - 2.0 * self.tip_rad)
        return np.where(shins.lowest_pitch > most, behind, self.ahead(pitch, height_m, level))

    def ahead(self, pitch: Array, height_m: Array, level: Array) -> Array:
        """Nearest pitches (F, 2) [rad] with no heel or tip below the ground; `level` has cosines of rolls."""
        least, most = self._range(height_m, level)
        return np.clip(pitch, np.minimum(least, most), most)

    def on_toes(self, height_m: Array) -> Array:
        """(F, 2) pitches that put the tips on the ground, the ankles being higher than above flat feet."""
        return np.asarray(np.arcsin(np.clip(height_m / self.tip_m, -1.0, 1.0)) - self.tip_rad)

    def _range(self, height_m: Array, level: Array) -> tuple[Array, Array]:
        """(F, 2) pitches at which heel and tip touch the ground; infinite where they are too high to."""
        reach = np.maximum(level, 1e-6)
        tip, heel = height_m / (reach * self.tip_m), height_m / (reach * self.heel_m)
        least = np.where(heel < 1.0, self.heel_rad - np.arcsin(np.clip(heel, -1.0, 1.0)), -np.inf)
        most = np.where(tip < 1.0, np.arcsin(np.clip(tip, -1.0, 1.0)) - self.tip_rad, np.inf)
        return least, most

    def _depth_m(self, pitch: Array) -> Array:
        """(..., 2) depth of the lower of heel and tip below the ankle [m]."""
        heel = self.heel_m * np.sin(self.heel_rad - pitch)
        tip = self.tip_m * np.sin(self.tip_rad + pitch)
        return np.asarray(np.maximum(heel, tip))


# --- The ground under each foot


NOISE_M = 0.03  # two rests on one floor differ by no more than this unless one is on the toes


@dataclass(frozen=True, eq=False)
class FootGround:
    """The ground under both feet in F frames."""

    height_m: (
        Array  # (F, 2) height of the ground under the left and the right foot, nowhere above the ankle [m]
    )
    floor_m: Array  # (F, 2) the same by the feet's rests alone: between two of them the lower one's [m]
    resting: Array  # (F, 2) how far the foot rests flat, 0 to 1
    on_toes: Array  # (F, 2) how far it rests on its toes, 0 to 1


def find_ground(shins: Shins, soles: Soles, time_s: Array, contacts: Sequence[Contact]) -> FootGround:
    """Find the ground under both feet, by rests of the ankles, 0 the left and 1 the right."""
    beneath = shins.ankle[..., 2] - soles.clearance_m(shins)
    own = [float(beneath[c.first : c.last + 1, c.point].mean()) for c in contacts]
    levels = [_floor(index, contacts, own) for index in range(len(contacts))]
    resting, on_toes = np.zeros_like(beneath), np.zeros_like(beneath)
    for contact, level, flat in zip(contacts, levels, own, strict=True):
        rows = slice(contact.first, contact.last + 1)
        weight = resting if flat - level < NOISE_M else on_toes
        weight[rows, contact.point] = _settled(time_s[rows])
    if contacts:
        height, floor = (
            np.stack([_between(foot, contacts, levels, time_s, lower) for foot in range(2)], axis=-1)
            for lower in (False, True)
        )
    else:
        height = floor = np.repeat(_lower_foot(beneath, time_s)[:, None], 2, axis=-1)
    # A rest's own height is that of its ankle in every frame: what the ankle errs by, the ground has.
    height = (1.0 - resting) * height + resting * beneath
    return FootGround(np.minimum(height, beneath), floor, resting, on_toes)


def on_ground(contacts: Sequence[Contact]) -> tuple[Contact, ...]:
    """The rests of feet that are not just held still in the air."""

    def beside(contact: Contact, other: Contact) -> bool:
        shared = min(contact.last, other.last) - max(contact.first, other.first)
        return other.point != contact.point and 2 * shared > contact.last - contact.first

    return tuple(
        contact
        for contact in contacts
        if not any(
            # So much higher than the other one, which rests meanwhile, a foot is held in the air.
            beside(contact, other) and contact.place[2] - other.place[2] > 0.3
            for other in contacts
        )
    )


def _floor(index: int, contacts: Sequence[Contact], own: Sequence[float]) -> float:
    """The ground's height at a rest: the lowest of those at the same place, if it is well below."""
    here = contacts[index].place[:2]
    near = [
        height
        for contact, height in zip(contacts, own, strict=True)
        # Distance on the ground within which two rests are on one floor.
        if np.linalg.norm(contact.place[:2] - here) < 0.12
    ]
    return min(near) if own[index] - min(near) >= NOISE_M else own[index]


def _settled(time_s: Array) -> Array:
    """(N,) rises from 0 at a rest's beginning to 1, and falls to 0 at its end."""
    # Time from the beginning of a rest until the foot lies, and from when it begins to roll off to its end.
    edge = np.minimum(time_s - time_s[0], time_s[-1] - time_s) / 0.1
    return smooth_step(edge)


def _between(
    foot: int, contacts: Sequence[Contact], levels: Sequence[float], time_s: Array, lower: bool
) -> Array:
    """(F,) the ground under a foot: at its rests, and beyond them at the other foot's.

    Between two rests it goes from one to the other, or is that of the lower one.
    """
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
        # Coming down and rolling off, the foot is over the same ground.
        rolling = min(0.15, (stop - start) / 3.0)
        share = (time_s - start - rolling) / max(stop - start - 2.0 * rolling, 1e-9)
        if lower:
            height[before.last + 1 : after.first], height[after.first :] = min(low, high), high
        else:
            height[before.last :] = low + (high - low) * smooth_step(share[before.last :])
    return height


def _lower_foot(beneath: Array, time_s: Array) -> Array:
    """(F,) where the lower foot is for a share of the time around each frame."""
    lower = beneath.min(axis=1)
    edges = np.searchsorted(time_s, [time_s - NEIGHBORHOOD_S, time_s + NEIGHBORHOOD_S])
    # Where no foot ever rests, the ground is where the lower foot is for this share of the time.
    return np.array([np.quantile(lower[a : b + 1], 0.1) for a, b in edges.T], dtype=np.float64)


def smooth_step(share: Array) -> Array:
    """0 below 0, 1 above 1, and smooth in between."""
    s = np.clip(share, 0.0, 1.0)
    return np.asarray(s * s * (3.0 - 2.0 * s))


def smooth_above(needed: Array, time_s: Array, reach_s: float) -> Array:
    """A smooth signal (F,) nowhere below the needed one: its running maximum over the reach, smoothed."""
    if len(needed) < 3 or not needed.any():
        return np.array(needed)
    step = float(np.median(np.diff(time_s)))
    frames = max(1, int(np.ceil(reach_s / step)))
    highest = maximum_filter1d(needed, 2 * frames + 1, mode="nearest")
    window = np.hanning(2 * frames + 3)[1:-1]
    return np.asarray(convolve1d(highest, window / window.sum(), mode="nearest"))


# --- Feet that are in the ground all the same


IN_FLOOR_M = 0.002
"""Depth from which a foot counts as below the floor, at a performer's size [m]: more than key reduction may
make of it."""
MOST_RUNS = 3  # stretches of frames that a sentence names


def floor_notes(
    depth_m: Mapping[str, Array], frames: Array, whose: str = "", size: float = 1.0
) -> tuple[str, ...]:
    """Sentences, without a full stop, on feet that are in the floor: which, how deep, and in which frames.

    Depths (F,) are by side, negative above the floor; `whose` follows the foot, and `size` is the body's over
    a performer's.
    """
    notes = []
    for side, depth in depth_m.items():
        deep = np.flatnonzero(depth > size * IN_FLOOR_M)
        if len(deep):
            runs = np.split(deep, np.flatnonzero(np.diff(deep) > 1) + 1)
            longest = sorted(runs, key=lambda run: -float(depth[run].max()))[:MOST_RUNS]
            named = [
                f"{frames[run[0]]:g}" if len(run) == 1 else f"{frames[run[0]]:g} to {frames[run[-1]]:g}"
                for run in sorted(longest, key=lambda run: int(run[0]))
            ]
            more = f" and {len(runs) - MOST_RUNS} more times" if len(runs) > MOST_RUNS else ""
            notes.append(
                f"The {'left' if side == 'L' else 'right'} foot{whose} is up to "
                f"{1000.0 * float(depth.max()):.3g} mm below the floor, in frames {', '.join(named)}{more}"
            )
    return tuple(notes)
