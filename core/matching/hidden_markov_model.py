"""Hidden Markov model over postures and headings: Viterbi path and posterior probabilities.

A *state* is one posture of the sequences in one heading. Beside the transitions within a sequence any state
may jump to any other at a price, as when one movement ends and another begins. The likelihoods are tempered,
since neighboring frames are not independent: a performer who differs from the library's posture does so for a
while.
"""

from collections.abc import Generator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..arrays import Array, IndexArray, Int32Array, SingleArray
from .emissions import FrameEmissions, StateFeatures
from .frame_likelihood import FrameLikelihood
from .posture_sequences import PostureSequences
from .transitions import Shifts, Transition, frame_transitions

JUMP_RATE = 0.4
"""Jumps to another posture per second: one movement lasts a few seconds."""
FRAMES_A_YIELD = 50
JUMP_TURN_STD_RAD, JUMP_TURN_UNIFORM = 0.3, 0.1
"""Turn at a jump: normal about the same heading [rad], with a uniform share for the few who turn anyhow."""

Step = tuple[int, Sequence[Transition], np.float32]
"""To a frame: its index, the transitions there, the log probability of a jump to one state."""


@dataclass(frozen=True, eq=False)
class HiddenMarkovModel:
    """States and transitions of T frames; `add_transitions` comes before either recursion."""

    sequences: PostureSequences
    features: StateFeatures
    likelihoods: list[FrameLikelihood]
    emissions: list[FrameEmissions]
    tempering: float
    """Factor of the log likelihoods, at most 1."""
    time_s: Array
    """(T,)."""
    _steps: list[Step] = field(default_factory=list)

    # Long clips have thousands of steps: each recursion yields, so that a job can be canceled.

    def add_transitions(self) -> Generator[None, None, None]:
        """Find the transitions from each frame to the next."""
        for index in range(1, len(self.likelihoods)):
            duration = float(self.time_s[index] - self.time_s[index - 1])
            likelihoods = self.likelihoods[index - 1], self.likelihoods[index]
            emissions = self.emissions[index - 1], self.emissions[index]
            jump = np.float32(np.log(-np.expm1(-JUMP_RATE * duration)) - np.log(self._count))
            self._steps.append(
                (index, frame_transitions(self._shifts, duration, likelihoods, emissions), jump)
            )
            if index % FRAMES_A_YIELD == 0:
                yield

    def viterbi(self) -> Generator[None, None, IndexArray]:
        """(T,) states of the most probable path (Viterbi)."""
        score = self._log_likelihood(0)
        sources = []
        for index, transitions, jump in self._steps:
            if index % FRAMES_A_YIELD == 0:
                yield
            origins, gained = self._best_jumps(score, index - 1)
            headings = self._headings_of(index)
            best, source = gained[headings] + jump, origins[headings]
            for transition in transitions:
                through = score[transition.origin] + transition.weight
                better = through > best[transition.target]
                rows = transition.target[better]
                best[rows] = through[better]
                source[rows] = transition.origin[better]
            sources.append(source)
            score = best + self._log_likelihood(index)
        last = [int(score.argmax())]
        for source in reversed(sources):
            last.append(int(source[last[-1]]))
        return np.array(
            [emission.states[row] for emission, row in zip(self.emissions, last[::-1], strict=True)]
        )

    def forward_backward(self) -> Generator[None, None, list[SingleArray]]:
        """Posterior probability (K,) of each frame's states."""
        steps = self._steps
        forward = [self._log_likelihood(0) - np.float32(np.log(self._count))]
        for index, transitions, jump in steps:
            if index % FRAMES_A_YIELD == 0:
                yield
            total = self._summed_jumps(forward[-1], index - 1)[self._headings_of(index)] + jump
            for transition in transitions:
                through = forward[-1][transition.origin] + transition.weight
                total[transition.target] = np.logaddexp(total[transition.target], through)
            forward.append(total + self._log_likelihood(index))
        backward = np.zeros(len(forward[-1]), dtype=np.float32)
        posteriors = [_normalized(forward[-1])]
        for index, transitions, jump in reversed(steps):
            if index % FRAMES_A_YIELD == 0:
                yield
            ahead = backward + self._log_likelihood(index)
            backward = self._summed_jumps(ahead, index)[self._headings_of(index - 1)] + jump
            for transition in transitions:
                through = ahead[transition.target] + transition.weight
                backward[transition.origin] = np.logaddexp(backward[transition.origin], through)
            posteriors.append(_normalized(forward[index - 1] + backward))
        return posteriors[::-1]

    def _headings_of(self, index: int) -> IndexArray:
        """(K,) index of the heading of each of a frame's states."""
        return np.asarray(self.emissions[index].states % len(self.features.heading_rad))

    @cached_property
    def _jump_turns(self) -> SingleArray:
        """(H, H) log probability of a jump between two headings, relative to a uniform one."""
        count = len(self.features.heading_rad)
        apart = np.abs(np.arange(count)[:, None] - np.arange(count))
        angle = np.minimum(apart, count - apart) * (2.0 * np.pi / count)
        kept = np.exp(-0.5 * (angle / JUMP_TURN_STD_RAD) ** 2)
        share = (1.0 - JUMP_TURN_UNIFORM) * kept / kept.sum(axis=0) + JUMP_TURN_UNIFORM / count
        return np.asarray(np.log(share * count), dtype=np.float32)

    def _best_jumps(self, score: SingleArray, index: int) -> tuple[Int32Array, SingleArray]:
        """(H,) the best of a frame's states to jump from into each heading, and its score."""
        count = len(self.features.heading_rad)
        most, heading = np.full(count, -np.inf, dtype=np.float32), self._headings_of(index)
        np.maximum.at(most, heading, score)
        row = np.zeros(count, dtype=np.int32)
        holds = np.flatnonzero(score == most[heading])
        row[heading[holds]] = holds
        through = most[:, None] + self._jump_turns
        origin = through.argmax(axis=0)
        return row[origin], through[origin, np.arange(count)]

    def _summed_jumps(self, score: SingleArray, index: int) -> SingleArray:
        """(H,) log sum over a frame's states of the probability of a jump into each heading."""
        largest = float(score.max())
        share = np.exp(score - np.float32(largest), dtype=np.float64)
        total = np.bincount(self._headings_of(index), share, len(self.features.heading_rad))
        summed = np.exp(self._jump_turns.astype(np.float64)) @ total  # symmetric
        return np.asarray(largest + np.log(summed), dtype=np.float32)

    @property
    def _count(self) -> int:
        return len(self.sequences) * len(self.features.heading_rad)

    @cached_property
    def _shifts(self) -> Shifts:
        return Shifts(self.sequences, self.features.heading_rad)

    def _log_likelihood(self, index: int) -> SingleArray:
        return self.emissions[index].cost * np.float32(-self.tempering)


def _normalized(log_probability: SingleArray) -> SingleArray:
    share = np.exp(log_probability - log_probability.max())
    return np.asarray(share / share.sum())
