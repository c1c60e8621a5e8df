"""A plausible order over time: the best way through postures and headings, and how probable each is.

A *state* is one posture of the chains in one heading; at a price it may be followed by any other, as when
one movement ends and another begins. The likelihoods are tempered: a performer who is off the library's
posture is off in the same way for a while.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .chains import Chains
from .sights import Sight
from .steps import NOWHERE, Roads, Step, step
from .sweep import Fit, Turned, places

Array = NDArray[np.float64]
Single = NDArray[np.float32]

JUMP_RATE = 0.4
"""Jumps to another posture per second: a movement of a kind takes a few seconds."""


@dataclass(frozen=True, eq=False)
class Lattice:
    """The states of T frames: N postures in H headings."""

    chains: Chains
    states: Turned
    sights: list[Sight]
    fits: list[Fit]
    tempering: float
    """What the logarithms of the likelihoods count for."""
    time_s: Array
    """(T,)."""

    @cached_property
    def log_likelihood(self) -> Single:
        """(T, N H), tempered."""
        return np.stack([fit.cost for fit in self.fits]) * np.float32(-self.tempering)

    @cached_property
    def _roads(self) -> Roads:
        return Roads(self.chains, self.states.heading_rad)

    def best_path(self) -> NDArray[np.intp]:
        """(T,) states of the best way through (Viterbi)."""
        score = self.log_likelihood[0]
        sources = []
        for index, moves, jump in self._steps():
            leap = int(score.argmax())
            best = np.full_like(score, score[leap] + jump)
            source = np.full(len(score), leap, dtype=np.int32)
            known = np.append(score, NOWHERE)
            for road, weight in moves.moves:
                through = known[road.origin] + weight
                better = through > best
                np.copyto(best, through, where=better)
                np.copyto(source, road.origin, where=better)
            sources.append(source)
            score = best + self.log_likelihood[index]
        path = [int(score.argmax())]
        for source in reversed(sources):
            path.append(int(source[path[-1]]))
        return np.array(path[::-1], dtype=np.intp)

    def posterior(self) -> tuple[Single, float]:
        """(T, N H) probability of each state in each frame, and the logarithm of all their evidence."""
        steps = list(self._steps()) if len(self.sights) < 400 else None
        forward = np.empty_like(self.log_likelihood)
        total = len(forward[0])
        forward[0] = self.log_likelihood[0] - np.float32(np.log(total))
        for index, moves, jump in steps or self._steps():
            terms = [np.full(total, _log_sum(forward[index - 1]) + jump, dtype=np.float32)]
            known = np.append(forward[index - 1], NOWHERE)
            terms += [known[road.origin] + weight for road, weight in moves.moves]
            forward[index] = np.logaddexp.reduce(terms, axis=0) + self.log_likelihood[index]
        evidence = _log_sum(forward[-1])
        backward = np.zeros(total, dtype=np.float32)
        for index, moves, jump in reversed(steps or list(self._steps())):
            ahead = backward + self.log_likelihood[index]
            terms = [np.full(total, _log_sum(ahead) + jump, dtype=np.float32)]
            terms += [np.append(ahead + weight, NOWHERE)[road.target] for road, weight in moves.moves]
            backward = np.logaddexp.reduce(terms, axis=0)
            forward[index - 1] += backward
        forward -= forward.max(axis=1, keepdims=True)
        share = np.exp(forward)
        share /= share.sum(axis=1, keepdims=True)
        return share, evidence

    def _steps(self) -> Iterator[tuple[int, Step, np.float32]]:
        total = self.log_likelihood.shape[1]
        before = places(self.sights[0], self.states, self.fits[0])
        for index in range(1, len(self.sights)):
            after = places(self.sights[index], self.states, self.fits[index])
            duration = float(self.time_s[index] - self.time_s[index - 1])
            pair = self.sights[index - 1], self.sights[index]
            jump = np.float32(np.log(-np.expm1(-JUMP_RATE * duration)) - np.log(total))
            yield index, step(self._roads, duration, pair, before, after), jump
            before = after


def _log_sum(values: Single) -> float:
    most = float(values.max())
    return most + float(np.log(np.exp(values - most, dtype=np.float64).sum()))
