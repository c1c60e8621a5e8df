"""The chains of a library as tables that are read at any time: markers, height and way."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array, IndexArray
from ..body.heading import yaw_rotation, yawed_at
from ..body.posture import Posture
from .marker_moments import Solids
from .posture_sequences import Chains


@dataclass(frozen=True, eq=False)
class Reading:
    """What T times of chains hold, in the axes of a motion that heads straight ahead at its beginning."""

    middle: Array
    """(T, M, 3) [m]."""
    spread: Array
    """(T, M, 3, 3) [m²]."""
    height: Array
    """(T,) [m]."""
    way: Array
    """(T, 3) where the hips are, relative to where they were at the chain's time 0 [m]."""


@dataclass(frozen=True, eq=False)
class CourseTable:
    """All chains at their steps of time, a cycle's first posture once more at its end."""

    chains: Chains
    solids: Solids

    @cached_property
    def _rows(self) -> tuple[IndexArray, IndexArray]:
        """The posture of each row, and where each chain's rows begin."""
        rows, start = [], [0]
        for first, chain in zip(self.chains.start, self.chains.chains, strict=False):
            own = first + np.arange(len(chain))
            rows.append(np.append(own, first) if chain.cyclic else own)
            start.append(start[-1] + len(rows[-1]))
        return np.concatenate(rows), np.array(start)

    @cached_property
    def _turned(self) -> tuple[Array, Array, Array]:
        """Middles, spreads and ways (R, 3) of all rows; a cycle's end is turned by what the cycle turns."""
        rows, start = self._rows
        middle, spread = self.solids.middle[rows], self.solids.spread[rows]
        way = np.zeros((len(rows), 3))
        for index, chain in enumerate(self.chains.chains):
            own = slice(start[index], start[index + 1])
            count = len(chain)
            track = chain.track[count : 2 * count + 1] if chain.cyclic else chain.track
            way[own, :2] = track - track[0]
            way[own, 2] = self.solids.height[rows[own]] - self.solids.height[rows[own.start]]
            if chain.cyclic:
                turn = yaw_rotation(np.array(chain.turn_rad))
                middle[own.stop - 1] = middle[own.stop - 1] @ turn.T
                spread[own.stop - 1] = turn @ spread[own.stop - 1] @ turn.T
        return middle, spread, way

    def _between(self, chain: IndexArray, time_s: Array) -> tuple[IndexArray, IndexArray, Array, IndexArray]:
        """(T,) the rows before and after some times, how far between them, and in which cycle."""
        _, start = self._rows
        step = np.array([entry.step_s for entry in self.chains.chains])[chain]
        place = np.where(step > 0.0, time_s / np.where(step > 0.0, step, 1.0), 0.0)
        last = (np.diff(start) - 1)[chain]
        cyclic = np.array([entry.cyclic for entry in self.chains.chains])[chain]
        cycle = np.where(cyclic, np.floor(place / np.maximum(last, 1)), 0.0)
        local = np.clip(place - cycle * last, 0.0, last)
        low = np.minimum(local.astype(np.intp), np.maximum(last - 1, 0))
        first = start[:-1][chain] + low
        second = np.minimum(first + 1, start[1:][chain] - 1)
        return first, second, local - low, cycle.astype(np.intp)

    def read(self, chain: IndexArray, time_s: Array) -> Reading:
        """What the chains hold at some times; before a chain's beginning and after its end it rests."""
        rows, _ = self._rows
        middles, spreads, ways = self._turned
        first, second, share, cycle = self._between(chain, time_s)

        def between(values: Array) -> Array:
            weight = share.reshape(-1, *[1] * (values.ndim - 1))
            return np.asarray((1.0 - weight) * values[first] + weight * values[second])

        turn = self._turn(chain, cycle)
        middle = between(middles) @ np.swapaxes(turn, -1, -2)
        spread = turn[:, None] @ between(spreads) @ np.swapaxes(turn, -1, -2)[:, None]
        way = self._carried(between(ways), chain, cycle)
        return Reading(middle, spread, between(self.solids.height[rows]), way)

    def points(self, chain: IndexArray, time_s: Array) -> Array:
        """(T, P, 3) the body's points at some times, relative to the hips [m], in the axes of `read`."""
        rows, start = self._rows
        points = self.solids.points[rows]
        for index, entry in enumerate(self.chains.chains):
            points[start[index + 1] - 1] = (
                points[start[index + 1] - 1] @ yaw_rotation(np.array(entry.turn_rad)).T
            )
        first, second, share, cycle = self._between(chain, time_s)
        weight = share[:, None, None]
        between = (1.0 - weight) * points[first] + weight * points[second]
        return np.asarray(between @ np.swapaxes(self._turn(chain, cycle), -1, -2))

    def posture(self, chain: IndexArray, time_s: Array, heading_rad: Array, hips: Array) -> Posture:
        """(T,) postures at some times, with headings of the motion's beginning and places of the hips [m]."""
        rows, start = self._rows
        first, second, share, cycle = self._between(chain, time_s)
        ends = np.zeros(len(rows))
        ends[start[1:] - 1] = [entry.turn_rad for entry in self.chains.chains]
        postures = yawed_at(self.chains.posture[rows], ends, np.zeros((len(rows), 3)))
        led = postures[first].plus(share[:, None] * postures[second].minus(postures[first]))
        turned = np.array([entry.turn_rad for entry in self.chains.chains])[chain]
        return yawed_at(led, heading_rad + cycle * turned, hips)

    def nearest(self, chain: IndexArray, time_s: Array) -> IndexArray:
        """(T,) which of the N postures of the chains is nearest in time."""
        first, second, share, _ = self._between(chain, time_s)
        return self._rows[0][np.where(share < 0.5, first, second)]

    def _turn(self, chain: IndexArray, cycle: IndexArray) -> Array:
        return yaw_rotation(cycle * np.array([entry.turn_rad for entry in self.chains.chains])[chain])

    def _carried(self, way: Array, chain: IndexArray, cycle: IndexArray) -> Array:
        """Places (T, 3) that come again some cycles later."""
        _, start = self._rows
        ends = self._turned[2][start[1:] - 1]  # (C, 3)
        turns = np.array([entry.turn_rad for entry in self.chains.chains])
        carried = np.array(way)
        for index in np.unique(chain[cycle != 0]):
            turn = yaw_rotation(turns[index])
            own = (chain == index) & (cycle != 0)
            for count in np.unique(cycle[own]):
                rows = own & (cycle == count)
                moved = carried[rows]
                for _ in range(abs(int(count))):
                    moved = moved @ turn.T + ends[index] if count > 0 else (moved - ends[index]) @ turn
                carried[rows] = moved
        return carried
