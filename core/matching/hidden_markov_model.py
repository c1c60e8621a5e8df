"""A plausible order over time: the best way through postures and headings, and how probable each is.

A *state* is one posture of the chains in one heading; at a price it may be followed by any other, as when
one movement ends and another begins. The likelihoods are tempered: a performer who is off the library's
posture is off in the same way for a while.
"""

from collections.abc import Generator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, IndexArray, SingleArray
from .emissions import Fit, Turned
from .frame_likelihood import Sight
from .posture_sequences import Chains
from .transitions import Move, Roads, moves

JUMP_RATE = 0.4
"""Jumps to another posture per second: a movement of a kind takes a few seconds."""
AT_ONCE = 50
LEAP_TURN, LEAP_ANYHOW = 0.3, 0.1
"""Who begins another movement goes on facing the same way, within so much [rad]; a few turn anyhow."""

Step = tuple[int, Sequence[Move], np.float32]
"""To a frame: its index, the ways there, the logarithm of a jump's probability."""


@dataclass(frozen=True, eq=False)
class Lattice:
    """The states of T frames."""

    chains: Chains
    turned: Turned
    sights: list[Sight]
    fits: list[Fit]
    tempering: float
    """What the logarithms of the likelihoods count for."""
    time_s: Array
    """(T,)."""
    _steps: list[Step] = field(default_factory=list)

    # Long clips have thousands of steps: all that goes through them yields, so that whoever waits can stop.

    def connect(self) -> Generator[None, None, None]:
        """Find the ways from each frame to the next; comes before all else."""
        for index in range(1, len(self.sights)):
            duration = float(self.time_s[index] - self.time_s[index - 1])
            sights = self.sights[index - 1], self.sights[index]
            fits = self.fits[index - 1], self.fits[index]
            jump = np.float32(np.log(-np.expm1(-JUMP_RATE * duration)) - np.log(self._count))
            self._steps.append((index, moves(self._roads, duration, sights, fits), jump))
            if index % AT_ONCE == 0:
                yield

    def best_path(self) -> Generator[None, None, IndexArray]:
        """(T,) states of the best way through (Viterbi)."""
        score = self._log_likelihood(0)
        sources = []
        for index, ways, jump in self._steps:
            if index % AT_ONCE == 0:
                yield
            leaps, gained = self._leaps(score, index - 1)
            headings = self._heading(index)
            best, source = gained[headings] + jump, leaps[headings]
            for way in ways:
                through = score[way.origin] + way.weight
                better = through > best[way.target]
                rows = way.target[better]
                best[rows] = through[better]
                source[rows] = way.origin[better]
            sources.append(source)
            score = best + self._log_likelihood(index)
        last = [int(score.argmax())]
        for source in reversed(sources):
            last.append(int(source[last[-1]]))
        return np.array([fit.states[row] for fit, row in zip(self.fits, last[::-1], strict=True)])

    def posterior(self) -> Generator[None, None, tuple[list[SingleArray], float]]:
        """Of each frame the probability of its states, (K,); and the logarithm of the whole evidence."""
        steps = self._steps
        forward = [self._log_likelihood(0) - np.float32(np.log(self._count))]
        for index, ways, jump in steps:
            if index % AT_ONCE == 0:
                yield
            total = self._leapt(forward[-1], index - 1)[self._heading(index)] + jump
            for way in ways:
                through = forward[-1][way.origin] + way.weight
                total[way.target] = np.logaddexp(total[way.target], through)
            forward.append(total + self._log_likelihood(index))
        evidence = _log_sum(forward[-1])
        backward = np.zeros(len(forward[-1]), dtype=np.float32)
        shares = [_share(forward[-1])]
        for index, ways, jump in reversed(steps):
            if index % AT_ONCE == 0:
                yield
            ahead = backward + self._log_likelihood(index)
            backward = self._leapt(ahead, index)[self._heading(index - 1)] + jump
            for way in ways:
                through = ahead[way.target] + way.weight
                backward[way.origin] = np.logaddexp(backward[way.origin], through)
            shares.append(_share(forward[index - 1] + backward))
        return shares[::-1], evidence

    def _heading(self, index: int) -> IndexArray:
        """(K,) which heading each of a frame's states has."""
        return np.asarray(self.fits[index].states % len(self.turned.heading_rad))

    @cached_property
    def _leap_turns(self) -> SingleArray:
        """(H, H) logarithm of what a jump between two headings is more probable than between any."""
        count = len(self.turned.heading_rad)
        apart = np.abs(np.arange(count)[:, None] - np.arange(count))
        angle = np.minimum(apart, count - apart) * (2.0 * np.pi / count)
        kept = np.exp(-0.5 * (angle / LEAP_TURN) ** 2)
        share = (1.0 - LEAP_ANYHOW) * kept / kept.sum(axis=0) + LEAP_ANYHOW / count
        return np.asarray(np.log(share * count), dtype=np.float32)

    def _leaps(self, score: SingleArray, index: int) -> tuple[NDArray[np.int32], SingleArray]:
        """(H,) from which of a frame's states a jump into each heading comes best, and its score."""
        count = len(self.turned.heading_rad)
        most, heading = np.full(count, -np.inf, dtype=np.float32), self._heading(index)
        np.maximum.at(most, heading, score)
        row = np.zeros(count, dtype=np.int32)
        holds = np.flatnonzero(score == most[heading])
        row[heading[holds]] = holds
        through = most[:, None] + self._leap_turns
        origin = through.argmax(axis=0)
        return row[origin], through[origin, np.arange(count)]

    def _leapt(self, score: SingleArray, index: int) -> SingleArray:
        """(H,) logarithm of the sum over a frame's states of what leads by a jump into each heading."""
        least = float(score.max())
        share = np.exp(score - np.float32(least), dtype=np.float64)
        total = np.bincount(self._heading(index), share, len(self.turned.heading_rad))
        leapt = np.exp(self._leap_turns.astype(np.float64)) @ total  # symmetric
        return np.asarray(least + np.log(leapt), dtype=np.float32)

    @property
    def _count(self) -> int:
        return len(self.chains) * len(self.turned.heading_rad)

    @cached_property
    def _roads(self) -> Roads:
        return Roads(self.chains, self.turned.heading_rad)

    def _log_likelihood(self, index: int) -> SingleArray:
        return self.fits[index].cost * np.float32(-self.tempering)


def _share(log_probability: SingleArray) -> SingleArray:
    share = np.exp(log_probability - log_probability.max())
    return np.asarray(share / share.sum())


def _log_sum(values: SingleArray) -> float:
    most = float(values.max())
    return most + float(np.log(np.exp(values - most, dtype=np.float64).sum()))
