"""The way that was found through a library's states, and what it is in times, headings and places."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray
from ..body.heading import yawed_at
from ..body.posture import Posture
from .emissions import Fit, Turned
from .frame_likelihood import Sight
from .posture_sequences import Chains
from .refinement import Course
from .transitions import FASTEST


@dataclass(frozen=True, eq=False)
class Path:
    """The best state of each of T frames."""

    chains: Chains
    turned: Turned
    sights: list[Sight]
    fits: list[Fit]
    best: IndexArray
    """(T,) state."""
    clock_s: Array
    """(T,) times of the frames."""

    def postures(self, frame: int, rows: IndexArray) -> Posture:
        """The postures of some of a frame's states, in the world."""
        fit = self.fits[frame]
        posture, heading = np.divmod(fit.states[rows], len(self.turned.heading_rad))
        hips = fit.hips[:, rows].T.astype(float)
        return yawed_at(self.chains.posture[posture], self.turned.heading_rad[heading], hips)

    def course(self) -> Course:
        """The path in times that go on over cycles, and headings that turn on."""
        posture, heading = np.divmod(self.best, len(self.turned.heading_rad))
        chain = self.chains.chain_of[posture]
        own = posture - self.chains.start[chain]
        count = np.diff(self.chains.start)[chain]
        entries = [self.chains.chains[index] for index in chain]
        step = np.array([entry.step_s for entry in entries])
        cyclic = np.array([entry.cyclic for entry in entries])
        turn = np.array([entry.turn_rad for entry in entries])
        further = np.diff(own)
        further = np.where(cyclic[1:], further % count[1:], further)
        # Stochastic rounding may take one posture more than the fastest speed allows.
        most = np.ceil(FASTEST * np.diff(self.clock_s) / np.where(step > 0.0, step, np.inf)[1:]) + 1
        joined = (chain[1:] == chain[:-1]) & (further >= 0) & (further <= most)
        # A whole cycle before the first frame's is kept free, so that times may still go back a little.
        cycle = np.ones(len(own))
        for row in range(1, len(own)):
            cycle[row] = cycle[row - 1] + (own[row] < own[row - 1]) if joined[row - 1] else 1.0
        cycle = np.where(cyclic, cycle, 0.0)
        angle = self.turned.heading_rad[heading] - cycle * turn
        for row in range(1, len(own)):
            angle[row] -= 2.0 * np.pi * np.round((angle[row] - angle[row - 1]) / (2.0 * np.pi))
        hips = np.stack(
            [fit.hips[:, fit.row(state)] for fit, state in zip(self.fits, self.best, strict=True)]
        )
        time = (own + cycle * count) * step
        return Course(chain, joined, np.column_stack([time, angle, hips]))
