"""A plausible order over time: the best way through postures and headings, and how probable each is.

A *state* is one posture of the chains in one heading; at a price it may be followed by any other, as when
one movement ends and another begins. The likelihoods are tempered: a performer who is off the library's
posture is off in the same way for a while.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .chains import Chains
from .sights import Sight
from .steps import Move, Roads, moves
from .sweep import Fit, Turned

Array = NDArray[np.float64]
Single = NDArray[np.float32]

JUMP_RATE = 0.4
"""Jumps to another posture per second: a movement of a kind takes a few seconds."""


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

    def best_path(self) -> NDArray[np.intp]:
        """(T,) states of the best way through (Viterbi)."""
        score = self._log_likelihood(0)
        sources = []
        for index, ways, jump in self._steps:
            leap = int(score.argmax())
            best = np.full(len(self.fits[index].states), score[leap] + jump)
            source = np.full(len(best), leap, dtype=np.int32)
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

    def posterior(self) -> tuple[list[Single], float]:
        """Of each frame the probability of its states, (K,); and the logarithm of the whole evidence."""
        steps = self._steps
        forward = [self._log_likelihood(0) - np.float32(np.log(self._count))]
        for index, ways, jump in steps:
            total = np.full(len(self.fits[index].states), _log_sum(forward[-1]) + jump, dtype=np.float32)
            for way in ways:
                through = forward[-1][way.origin] + way.weight
                total[way.target] = np.logaddexp(total[way.target], through)
            forward.append(total + self._log_likelihood(index))
        evidence = _log_sum(forward[-1])
        backward = np.zeros(len(forward[-1]), dtype=np.float32)
        shares = [_share(forward[-1])]
        for index, ways, jump in reversed(steps):
            ahead = backward + self._log_likelihood(index)
            backward = np.full(len(forward[index - 1]), _log_sum(ahead) + jump, dtype=np.float32)
            for way in ways:
                through = ahead[way.target] + way.weight
                backward[way.origin] = np.logaddexp(backward[way.origin], through)
            shares.append(_share(forward[index - 1] + backward))
        return shares[::-1], evidence

    @property
    def _count(self) -> int:
        return len(self.chains) * len(self.turned.heading_rad)

    @cached_property
    def _roads(self) -> Roads:
        return Roads(self.chains, self.turned.heading_rad)

    def _log_likelihood(self, index: int) -> Single:
        return self.fits[index].cost * np.float32(-self.tempering)

    @cached_property
    def _steps(self) -> list[tuple[int, list[Move], np.float32]]:
        """From each frame to the next: its index, the ways there, the logarithm of a jump's probability."""
        steps = []
        for index in range(1, len(self.sights)):
            duration = float(self.time_s[index] - self.time_s[index - 1])
            sights = self.sights[index - 1], self.sights[index]
            fits = self.fits[index - 1], self.fits[index]
            jump = np.float32(np.log(-np.expm1(-JUMP_RATE * duration)) - np.log(self._count))
            steps.append((index, moves(self._roads, duration, sights, fits), jump))
        return steps


def _share(log_probability: Single) -> Single:
    share = np.exp(log_probability - log_probability.max())
    return np.asarray(share / share.sum())


def _log_sum(values: Single) -> float:
    most = float(values.max())
    return most + float(np.log(np.exp(values - most, dtype=np.float64).sum()))
