"""The Viterbi path through a library's states, and its continuous times, headings and places."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array, IndexArray
from ..body.heading import yawed_at
from ..body.posture import Posture
from .emissions import FrameEmissions, StateFeatures
from .frame_likelihood import FrameLikelihood
from .posture_sequences import PostureSequences
from .refinement import ContinuousPath
from .transitions import FASTEST


@dataclass(frozen=True, eq=False)
class StatePath:
    """The state of each of T frames."""

    sequences: PostureSequences
    features: StateFeatures
    likelihoods: list[FrameLikelihood]
    emissions: list[FrameEmissions]
    best: IndexArray
    """(T,) the states."""
    time_s: Array
    """(T,) times of the frames."""

    def postures(self, frame: int, rows: IndexArray) -> Posture:
        """The postures of some of a frame's states, in the world."""
        emission = self.emissions[frame]
        posture, heading = np.divmod(emission.states[rows], len(self.features.heading_rad))
        hips = emission.hips[:, rows].T.astype(float)
        if not self.likelihoods[frame].visible.any():
            hips = np.broadcast_to(self.hips[frame], hips.shape)
        return yawed_at(self.sequences.posture[posture], self.features.heading_rad[heading], hips)

    @cached_property
    def hips(self) -> Array:
        """(T, 3) places of the hips on the path [m], interpolated over frames in which nothing is seen."""
        found = np.stack(
            [
                emission.hips[:, emission.index_of(state)]
                for emission, state in zip(self.emissions, self.best, strict=True)
            ]
        )
        seen = np.flatnonzero([likelihood.visible.any() for likelihood in self.likelihoods])
        if len(seen) in (0, len(found)):
            return found
        columns = [np.interp(self.time_s, self.time_s[seen], column[seen]) for column in found.T]
        return np.stack(columns, axis=-1)

    def continuous(self) -> ContinuousPath:
        """The path with times counted on over cycles and headings without jumps of full turns."""
        posture, heading = np.divmod(self.best, len(self.features.heading_rad))
        sequence = self.sequences.sequence_of[posture]
        own = posture - self.sequences.starts[sequence]
        count = np.diff(self.sequences.starts)[sequence]
        entries = [self.sequences.sequences[index] for index in sequence]
        step = np.array([entry.step_s for entry in entries])
        cyclic = np.array([entry.cyclic for entry in entries])
        turn = np.array([entry.turn_rad for entry in entries])
        further = np.diff(own)
        further = np.where(cyclic[1:], further % count[1:], further)
        # Stochastic rounding may take one posture more than the fastest speed allows.
        most = np.ceil(FASTEST * np.diff(self.time_s) / np.where(step > 0.0, step, np.inf)[1:]) + 1
        continues = (sequence[1:] == sequence[:-1]) & (further >= 0) & (further <= most)
        # A whole cycle before the first frame's is kept free, so that times may still go back a little.
        cycle = np.ones(len(own))
        for row in range(1, len(own)):
            cycle[row] = cycle[row - 1] + (own[row] < own[row - 1]) if continues[row - 1] else 1.0
        cycle = np.where(cyclic, cycle, 0.0)
        angle = self.features.heading_rad[heading] - cycle * turn
        for row in range(1, len(own)):
            angle[row] -= 2.0 * np.pi * np.round((angle[row] - angle[row - 1]) / (2.0 * np.pi))
        time = (own + cycle * count) * step
        return ContinuousPath(sequence, continues, np.column_stack([time, angle, self.hips]))
