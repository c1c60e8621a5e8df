"""A library's postures in a row: every motion at small steps of time, on the body of the take.

A motion becomes a *chain* of postures so close that the one between two neighbors is well known; so does its
mirror image, where that is another motion. A posture in no motion is a chain of its own.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..arrays import Array, IndexArray
from ..body.heading import UP
from ..body.kinematics import Body
from ..body.mirror import mirrored
from ..body.posture import Posture
from ..library.library import Library, LibraryMotion
from ..library.motion_playback import sample_motion
from ..library.transfer import transferred

STEP_M = 0.045
"""Points move about so far from one posture of a chain to the next: well below what performers differ by."""
LEAST_RATE, MOST_RATE = 8.0, 25.0
"""Postures per second of a motion."""
MOST_POSTURES = 450
"""Of a whole library: with more the steps are widened."""
TRAVELS_M = 0.3
"""A cycle that leads farther may also be done on the spot, as on a treadmill."""
SAME_M = 0.03
"""A mirror image whose points come this near to those of its motion half a cycle on adds nothing."""
MOST_SHIFTS = 100
"""Times of a cycle at which its mirror image is compared with it."""


@dataclass(frozen=True, eq=False)
class Chain:
    """One motion at equal steps of time."""

    posture: Posture
    """(N,) with the floor at z = 0, the place along the motion in x and y."""
    names: tuple[str, ...]
    """N names: of the library's posture that each is nearest to in time."""
    mirrored: bool
    step_s: float
    """Time from each to the next; 0 for a single posture."""
    cyclic: bool
    track: Array
    """(3 N, 2) the hips' place [m] in the cycle before, this one and the next; (N, 2) without cycles."""
    turn_rad: float
    """What a cycle adds to the heading."""
    motion: str
    """The motion's name; empty for a posture in no motion."""

    def __len__(self) -> int:
        """Number of postures."""
        return len(self.names)


@dataclass(frozen=True, eq=False)
class Chains:
    """All chains of a library, their N postures one after the other."""

    library: Library
    body: Body
    chains: tuple[Chain, ...]
    start: IndexArray = field(init=False)
    """(C + 1,) where each chain begins."""

    def __post_init__(self) -> None:
        """Count."""
        object.__setattr__(self, "start", np.cumsum([0, *(len(chain) for chain in self.chains)]))

    def __len__(self) -> int:
        """Number of postures N."""
        return int(self.start[-1])

    @cached_property
    def posture(self) -> Posture:
        """(N,) all postures."""
        return Posture.concatenate([chain.posture for chain in self.chains])

    @cached_property
    def chain_of(self) -> IndexArray:
        """(N,) the chain of each posture."""
        return np.repeat(np.arange(len(self.chains)), np.diff(self.start))

    @cached_property
    def step_s(self) -> Array:
        """(N,) time from each posture to the next of its chain."""
        return np.array([chain.step_s for chain in self.chains])[self.chain_of]

    def name(self, index: int) -> str:
        """Name of the library's posture that one of the N is nearest to."""
        chain = int(self.chain_of[index])
        return self.chains[chain].names[index - int(self.start[chain])]

    def is_mirrored(self, index: int) -> bool:
        """Whether left and right are exchanged in one of the N."""
        return self.chains[int(self.chain_of[index])].mirrored

    def advanced(self, steps: int) -> tuple[IndexArray, Array, Array]:
        """Where each posture leads.

        Args:
            steps: Postures to go on by, at most a cycle; negative ones go back.

        Returns:
            (N,) index of the posture that comes so many steps later, -1 where the chain has ended; (N, 2) the
            way there [m], in the axes of the motion; (N,) what the heading of the motion's axes changes by
            because a cycle has begun again [rad].
        """
        index = np.full(len(self), -1, dtype=np.intp)
        way, turn = np.zeros((len(self), 2)), np.zeros(len(self))
        for first, chain in zip(self.start, self.chains, strict=False):
            count = len(chain)
            own = np.arange(count)
            if not chain.cyclic:
                own = own[(own + steps >= 0) & (own + steps < count)]
            index[first + own] = first + (own + steps) % count
            if chain.cyclic and abs(steps) <= count:
                way[first + own] = chain.track[count + own + steps] - chain.track[count + own]
                turn[first + own] = (own + steps) // count * chain.turn_rad
            elif not chain.cyclic:
                way[first + own] = chain.track[own + steps] - chain.track[own]
        return index, way, turn


def library_chains(library: Library, body: Body) -> Chains:
    """All chains of a library on the body of a take."""
    spacing = 1.0
    chains = tuple(_chains(library, body, spacing))
    total = sum(len(chain) for chain in chains)
    if total > MOST_POSTURES:
        chains = tuple(_chains(library, body, total / MOST_POSTURES))
    return Chains(library, body, chains)


def _chains(library: Library, body: Body, spacing: float) -> Iterator[Chain]:
    used = {step.posture for motion in library.motions for step in motion.steps}
    for motion in library.motions:
        chain = _chain(library, motion, body, spacing)
        other = _mirrored(chain)
        for each in (chain,) if _repeats(chain, other, body) else (chain, other):
            yield each
            if each.cyclic and np.linalg.norm(each.track[len(each)] - each.track[0]) > TRAVELS_M:
                yield replace(each, track=np.zeros_like(each.track))
    for loose in library.postures:
        if loose.name in used:
            continue
        posture = Posture.stack([transferred(loose, library.actor, body)])
        single = Chain(posture, (loose.name,), False, 0.0, False, np.zeros((1, 2)), 0.0, "")
        yield single
        other = _mirrored(single)
        if not _repeats(single, other, body):
            yield other


def _chain(library: Library, motion: LibraryMotion, body: Body, spacing: float) -> Chain:
    """A motion at steps of time in which its points move about `STEP_M` times `spacing`."""
    whole = motion.duration_s if motion.cyclic else motion.steps[-1].time_s
    fine = np.linspace(0.0, whole, int(np.clip(np.ceil(whole * MOST_RATE) + 1, 3, MOST_POSTURES)))
    posture = sample_motion(library, motion, body, fine)
    points = body.points(body.pose(posture)) - posture.translation[:, None]
    way = float(np.linalg.norm(np.diff(points, axis=0), axis=-1).mean(axis=1).sum())
    rate = np.clip(way / STEP_M / max(whole, 1e-6), LEAST_RATE, MOST_RATE) / spacing
    count = int(np.clip(np.ceil(whole * rate), 3, MOST_POSTURES))
    step = whole / count if motion.cyclic else whole / (count - 1)
    time = step * np.arange(count)
    times = np.array([entry.time_s for entry in motion.steps])
    away = np.abs(time[:, None] - times)
    if motion.cyclic:
        away = np.minimum(away, whole - away)
    names = tuple(motion.steps[int(i)].posture for i in away.argmin(axis=1))
    sampled = sample_motion(library, motion, body, time)
    track = sampled.translation[:, :2]
    if motion.cyclic:
        around = step * np.arange(-count, 2 * count)
        track = sample_motion(library, motion, body, around).translation[:, :2]
    turn = motion.travel[2] if motion.cyclic else 0.0
    return Chain(sampled, names, False, step, motion.cyclic, track, turn, motion.name)


def _mirrored(chain: Chain) -> Chain:
    track = chain.track * np.array([-1.0, 1.0])
    posture = mirrored(chain.posture)
    return Chain(posture, chain.names, True, chain.step_s, chain.cyclic, track, -chain.turn_rad, chain.motion)


def _repeats(chain: Chain, other: Chain, body: Body) -> bool:
    """Whether a mirror image is its own motion again, at the same or, in a cycle, at another time."""
    first, second = (_shape(entry.posture, body) for entry in (chain, other))
    shifts = range(0, len(chain), -(-len(chain) // MOST_SHIFTS)) if chain.cyclic else (0,)
    apart = [np.linalg.norm(np.roll(second, shift, axis=0) - first, axis=-1).mean() for shift in shifts]
    return float(min(apart)) < SAME_M


def _shape(posture: Posture, body: Body) -> Array:
    """(N, P, 3) points relative to the hips, which keep their height."""
    return np.asarray(body.points(body.pose(posture)) - posture.translation[:, None] * (1.0 - UP))
